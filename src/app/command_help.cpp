#include "app/command_help.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "core/version.hpp"

namespace quicksand {

namespace {

constexpr std::size_t line_width = 92;
constexpr std::size_t summary_column = 31;
constexpr std::size_t option_column = 27;

struct Remark {
  const char* name;
  const char* text;
};

constexpr const char* description =
    "Quicksand computes violent free-surface flow of incompressible liquids and yield-stress slurries: explosions in "
    "water over sand, slugs that collapse, dams that break, tanks that slosh. A case is one YAML file; a run leaves a "
    "folder with tables, fields for ParaView and a summary.";

constexpr OptionHelp set_option = {
    "--set", "KEY.PATH=VALUE",
    "replace a value of the case, or add it; VALUE is YAML, items of lists go by number: --set time.end=1 --set "
    "species.0.density=2 --set 'gravity=[0, 0, -9.81]'. Repeatable, the last one wins"};

constexpr OptionHelp help_option = {"--help", nullptr, "print help; with a command, help on it"};

constexpr Remark exit_codes[] = {
    {"0", "finished"},
    {"1", "internal error"},
    {"2", "bad input: command line, case file, or a result folder that is not empty"},
    {"3", "numerical failure, after which the last good state is written, or out of memory"},
    {"4", "a file could not be read or written"},
    {"128 + N", "ended by signal N after a whole step, with fields and a checkpoint written"},
};

constexpr Remark environment[] = {
    {"OMP_NUM_THREADS", "most threads where --threads does not say"},
    {"UDUNITS2_XML_PATH", "database of units in place of the one installed with UDUNITS-2"},
};

/// Appends words to a line that has come to `column`, with line breaks before `line_width`.
void append_wrapped(std::string& out, std::string_view text, std::size_t column, std::size_t indent) {
  std::istringstream words{std::string(text)};
  bool first = true;
  for (std::string word; words >> word; first = false) {
    if (!first && column + 1 + word.size() > line_width) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!first) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  out += '\n';
}

/// A name with its explanation beside it, or below where the name is too long.
void append_entry(std::string& out, const std::string& name, std::string_view text, std::size_t column) {
  std::string start = "  " + name;
  if (start.size() + 2 > column) {
    out += start + "\n";
    start.clear();
  }
  start.resize(column, ' ');
  out += start;
  append_wrapped(out, text, column, column);
}

std::string name_and_value(const OptionHelp& option) {
  return option.value == nullptr ? option.name : std::string(option.name) + " " + option.value;
}

/// Name and argument of a command.
std::string call(const CommandHelp& command) {
  if (command.operand == nullptr) return command.name;
  const std::string operand = command.operand;
  return std::string(command.name) + " " + (command.operand_required ? operand : "[" + operand + "]");
}

/// Text as troff wants it: no dash that it could take for a hyphen, no line that begins like a request.
std::string troff(std::string_view text) {
  std::string escaped;
  for (const char letter : text) {
    if (letter == '\\')
      escaped += "\\e";
    else if (letter == '-')
      escaped += "\\-";
    else if (letter == '\'')
      escaped += "\\(aq";
    else
      escaped += letter;
  }
  return !escaped.empty() && escaped.front() == '.' ? "\\&" + escaped : escaped;
}

void append_troff_option(std::string& page, const OptionHelp& option) {
  page += ".TP\n\\fB" + troff(option.name) + "\\fR";
  if (option.value != nullptr) page += " \\fI" + troff(option.value) + "\\fR";
  page += "\n" + troff(option.text) + ".\n";
}

template <std::size_t N>
void append_troff_remarks(std::string& page, const char* title, const Remark (&remarks)[N]) {
  page += std::string(".SH ") + title + "\n";
  for (const Remark& remark : remarks) page += ".TP\n.B " + troff(remark.name) + "\n" + troff(remark.text) + ".\n";
}

}  // namespace

const std::vector<CommandHelp>& command_table() {
  static const std::vector<CommandHelp> table = {
      {Command::run,
       "run",
       "CASE.yaml",
       "a case file",
       true,
       "run a case",
       "Runs a case into its result folder: case.yaml with every default, history.csv with a line per step, fields at "
       "the times of output, checkpoints, summary.json. A folder that holds results already is refused unless "
       "--overwrite or --resume says what is meant. On SIGINT and SIGTERM the step is finished and a checkpoint "
       "written.",
       {set_option,
        {"--output", "DIR", "write results to DIR instead of the case's output.directory"},
        {"--overwrite", nullptr, "replace the results in an output folder that is not empty; other files stay"},
        {"--resume", nullptr, "go on from the last checkpoint in the output folder, to the same results"},
        {"--threads", "N", "most threads; fewer are used while they are faster; results do not depend on it"},
        {"--fixed-threads", nullptr, "use that number always, for measurements"},
        {"--quiet", nullptr, "no warnings, no progress"}},
       {"run configs/slug/case_e.yaml", "run mud.yaml --set time.end=0.5 --output results/short",
        "run mud.yaml --resume"}},
      {Command::check,
       "check",
       "CASE.yaml",
       "a case file",
       true,
       "read and validate a case, print what would run",
       "Reads and validates a case and prints what would run: cells, memory, volumes, the first time step, the state "
       "of "
       "bubbles and charges, and warnings. Of a wrong case all problems are printed at once, each with file, line, "
       "column and key.",
       {set_option, {"--strict", nullptr, "warnings count as bad input"}},
       {"check configs/umd_box/bubble_0295.yaml"}},
      {Command::show,
       "show",
       "CASE.yaml",
       "a case file",
       true,
       "print the case with every default filled in",
       "Prints the case with every default filled in, as YAML that runs again. With --explain every key has its "
       "meaning, "
       "values, default and usual values as a comment; without a case it prints one to begin with.",
       {set_option,
        {"--explain", nullptr,
         "with comments on every key; in place of the case also a key (time.cfl), or nothing for a case to begin "
         "with"}},
       {"show mud.yaml > mud_in_full.yaml", "show --explain time.cfl", "show --explain > new.yaml"}},
      {Command::schema,
       "schema",
       nullptr,
       nullptr,
       false,
       "print the JSON Schema of case files",
       "Prints the JSON Schema (draft 2020-12) of case files, from which editors complete and check keys.",
       {{"--markdown", nullptr, "all keys as a page in place of the schema"}},
       {"schema > case.schema.json"}},
      {Command::info,
       "info",
       "PATH",
       "a result folder, field file or checkpoint",
       true,
       "print what a result folder, field file or checkpoint holds",
       "Prints what a result folder, a field file or a checkpoint holds.",
       {},
       {"info results/slug_e", "info results/slug_e/fields_00000000.h5"}},
      {Command::manual,
       "manual",
       nullptr,
       nullptr,
       false,
       "print the manual page",
       "Prints the manual page for troff. Where the program is installed, `man quicksand` shows it.",
       {},
       {"manual | man -l -"}},
      {Command::version,
       "version",
       nullptr,
       nullptr,
       false,
       "print the versions of the program and its libraries",
       "Prints the versions of the program, its compiler and its libraries, and the number of processors. --version "
       "does the same.",
       {},
       {}},
      {Command::help,
       "help",
       "COMMAND",
       "a command",
       false,
       "print help, or help on a command",
       "Prints help, or help on a command, as --help does.",
       {},
       {"help run"}},
  };
  return table;
}

std::string general_help() {
  std::string out = "Quicksand: free-surface flow of liquids and yield-stress slurries\n\n";
  out += "usage:\n";
  for (const CommandHelp& command : command_table()) {
    append_entry(out, "quicksand " + call(command), command.summary, summary_column);
  }
  out += "\noptions (quicksand COMMAND --help says more):\n";
  std::vector<std::string_view> listed;
  for (const CommandHelp& command : command_table()) {
    for (const OptionHelp& option : command.options) {
      if (std::find(listed.begin(), listed.end(), option.name) != listed.end()) continue;
      listed.emplace_back(option.name);
      append_entry(out, name_and_value(option), option.text, option_column);
    }
  }
  append_entry(out, help_option.name, help_option.text, option_column);
  append_entry(out, "--version", "print versions", option_column);
  out += "\nexit codes:\n";
  for (const Remark& code : exit_codes) append_entry(out, code.name, code.text, 13);
  return out;
}

std::string command_help(const CommandHelp& command) {
  std::string out = std::string("quicksand ") + command.name + ": " + command.summary + "\n\nusage: quicksand " +
                    call(command) + (command.options.empty() ? "" : " [options]") + "\n\n";
  append_wrapped(out, command.text, 0, 0);
  out += "\noptions:\n";
  for (const OptionHelp& option : command.options) {
    append_entry(out, name_and_value(option), option.text, option_column);
  }
  append_entry(out, help_option.name, "print this text", option_column);
  if (!command.examples.empty()) out += "\nexamples:\n";
  for (const char* example : command.examples) out += std::string("  quicksand ") + example + "\n";
  return out;
}

std::string manual_page() {
  std::string page = ".TH QUICKSAND 1 \"\" \"quicksand " QUICKSAND_VERSION "\" \"User Commands\"\n";
  page += ".SH NAME\nquicksand \\- free\\-surface flow of liquids and yield\\-stress slurries\n.SH SYNOPSIS\n";
  for (const CommandHelp& command : command_table()) {
    page += ".B quicksand\n" + troff(call(command)) + "\n";
    if (!command.options.empty()) page += "[options]\n";
    page += ".br\n";
  }
  page += ".SH DESCRIPTION\n" + troff(description) + "\n.SH COMMANDS\n";
  for (const CommandHelp& command : command_table()) {
    page += ".SS " + troff(call(command)) + "\n" + troff(command.text) + "\n";
    for (const OptionHelp& option : command.options) append_troff_option(page, option);
  }
  page += ".SH OPTIONS\n";
  append_troff_option(page, help_option);
  append_troff_option(page, {"--version", nullptr, "print versions"});
  append_troff_remarks(page, "EXIT STATUS", exit_codes);
  append_troff_remarks(page, "ENVIRONMENT", environment);
  page += ".SH EXAMPLES\n.nf\n";
  for (const CommandHelp& command : command_table()) {
    for (const char* example : command.examples) page += "quicksand " + troff(example) + "\n";
  }
  return page + ".fi\n";
}

}  // namespace quicksand
