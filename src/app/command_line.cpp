#include "app/command_line.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <ostream>
#include <system_error>
#include <thread>
#include <utility>

#include "app/case_config.hpp"
#include "app/case_reference.hpp"
#include "app/case_report.hpp"
#include "app/case_warnings.hpp"
#include "app/output_folder.hpp"
#include "core/config_codec.hpp"
#include "core/errors.hpp"
#include "core/hdf5_file.hpp"
#include "solvers/multigrid.hpp"

#ifndef QUICKSAND_VERSION
#define QUICKSAND_VERSION "unknown"
#endif

namespace quicksand {

namespace {

constexpr const char* see_help = " (see quicksand --help)";

constexpr int most_threads = 4096;

struct CommandName {
  const char* name;
  Command command;
  const char* operand;  ///< what its path is, or null
};

constexpr CommandName commands[] = {
    {"run", Command::run, "a case file"},
    {"check", Command::check, "a case file"},
    {"show", Command::show, "a case file"},
    {"schema", Command::schema, nullptr},
    {"info", Command::info, "a result folder, field file or checkpoint"},
    {"help", Command::help, nullptr},
    {"--help", Command::help, nullptr},
    {"-h", Command::help, nullptr},
    {"version", Command::version, nullptr},
    {"--version", Command::version, nullptr},
};

const CommandName& find_command(const std::string& word) {
  std::vector<std::string> names;
  for (const CommandName& known : commands) {
    if (word == known.name) return known;
    names.emplace_back(known.name);
  }
  throw InputError("unknown command '" + word + "'" + suggestion(word, names) + see_help);
}

int parse_threads(const std::string& text) {
  int threads = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), threads);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || threads < 1 || threads > most_threads) {
    throw InputError("--threads must be a whole number from 1 to " + std::to_string(most_threads) + ", not '" + text +
                     "'");
  }
  return threads;
}

/// The options that a command takes.
std::vector<std::string> options_of(Command command) {
  switch (command) {
    case Command::run: return {"--set", "--output", "--threads", "--resume", "--overwrite", "--quiet"};
    case Command::check: return {"--set", "--strict"};
    case Command::show: return {"--set", "--explain"};
    case Command::schema: return {"--markdown"};
    default: return {};
  }
}

/// Walks over the arguments of a command.
class ArgumentReader {
 public:
  ArgumentReader(const std::vector<std::string>& arguments, std::size_t first) : arguments_(arguments), next_(first) {}

  bool done() const { return next_ == arguments_.size(); }
  const std::string& take() { return arguments_[next_++]; }
  /// Value of an option, given as the next argument or after `=`.
  std::string value(const std::string& option, const std::optional<std::string>& attached) {
    if (attached) return *attached;
    if (done()) throw InputError(option + " needs a value" + see_help);
    return take();
  }

 private:
  const std::vector<std::string>& arguments_;
  std::size_t next_;
};

void read_option(const std::string& argument, ArgumentReader& reader, const std::string& command, CommandLine& line) {
  const std::size_t equals = argument.find('=');
  const std::string option = argument.substr(0, equals);
  const bool has_value = equals != std::string::npos;
  const std::optional<std::string> attached = has_value ? std::optional(argument.substr(equals + 1)) : std::nullopt;
  const std::vector<std::string> known = options_of(line.command);
  if (std::find(known.begin(), known.end(), option) == known.end()) {
    const std::string list = known.empty() ? "; it takes no options" : "; allowed are " + join(known);
    throw InputError("unknown option " + option + " for '" + command + "'" + suggestion(option, known) + list);
  }
  if (option == "--set") {
    line.settings.push_back(reader.value(option, attached));
  } else if (option == "--output") {
    line.output = reader.value(option, attached);
    if (line.output->empty()) throw InputError("--output must not be empty");
  } else if (option == "--threads") {
    line.run.threads = parse_threads(reader.value(option, attached));
  } else if (option == "--explain" && has_value) {
    if (!line.path.empty()) throw InputError("--explain takes a key or a case, not both");
    line.explain = true;
    line.path = *attached;
  } else if (has_value) {
    throw InputError(option + " takes no value");
  } else {
    const std::pair<const char*, bool*> flags[] = {{"--overwrite", &line.overwrite}, {"--resume", &line.run.resume},
                                                   {"--quiet", &line.run.quiet},     {"--explain", &line.explain},
                                                   {"--markdown", &line.markdown},   {"--strict", &line.strict}};
    for (const auto& [name, value] : flags) {
      if (option == name) *value = true;
    }
  }
}

std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "g++ " __VERSION__;
#else
  return "unknown";
#endif
}

std::string version_text() {
  return std::string("quicksand ") + QUICKSAND_VERSION + "\ncompiler " + compiler() + "\nhypre " + hypre_version() +
         "\nHDF5 " + hdf5_version() + "\nthreads " + std::to_string(std::thread::hardware_concurrency()) + "\n";
}

/// What `show` prints: a case, with explanations or without, or those of a key.
std::string show(const CommandLine& line) {
  if (!line.explain) return to_yaml(read_case(line.path, line.settings));
  if (line.path.empty()) return case_template();
  std::error_code code;
  // What looks like a file is taken for one, so that a missing file is told from a misspelt key.
  const bool is_file = std::filesystem::exists(line.path, code) || line.path.find('/') != std::string::npos ||
                       line.path.ends_with(".yaml") || line.path.ends_with(".yml");
  return is_file ? explained_case(read_case(line.path, line.settings)) : explain_key(line.path);
}

int run(const CommandLine& line, std::ostream& err) {
  CaseConfig config = read_case(line.path, line.settings);
  if (line.output) config.output.directory = *line.output;
  // A run that goes on may read the case that it left in its folder: it writes the same again.
  if (!line.run.resume) protect_case_file(line.path, config.output.directory);
  if (!line.run.quiet) {
    for (const std::string& warning : located_warnings(config, line.path, line.settings)) {
      err << "warning: " << warning << "\n";
    }
  }
  if (!line.run.resume) prepare_output_folder(config.output.directory, line.overwrite);
  return run_case(config, line.run);
}

}  // namespace

CommandLine parse_command_line(const std::vector<std::string>& arguments) {
  CommandLine line;
  if (arguments.empty()) throw InputError(std::string("no command") + see_help);
  const CommandName& command = find_command(arguments.front());
  line.command = command.command;
  ArgumentReader reader(arguments, 1);
  bool options_end = false;
  while (!reader.done()) {
    const std::string argument = reader.take();
    if (!options_end && argument == "--") {
      options_end = true;
    } else if (!options_end && (argument == "--help" || argument == "-h")) {
      line.command = Command::help;
      return line;
    } else if (!options_end && argument.size() > 1 && argument.front() == '-') {
      read_option(argument, reader, command.name, line);
    } else if (command.operand == nullptr) {
      throw InputError(std::string("'") + command.name + "' takes no argument, but got '" + argument + "'");
    } else if (!line.path.empty()) {
      throw InputError(std::string("'") + command.name + "' takes one path, but got '" + line.path + "' and '" +
                       argument + "'");
    } else {
      line.path = argument;
    }
  }
  if (line.overwrite && line.run.resume) throw InputError("--resume and --overwrite exclude each other");
  if (command.operand != nullptr && line.path.empty() && !line.explain) {
    throw InputError(std::string("'") + command.name + "' needs " + command.operand + see_help);
  }
  return line;
}

std::string usage() {
  return "Quicksand: free-surface flow of liquids and yield-stress slurries\n"
         "\n"
         "usage:\n"
         "  quicksand run CASE.yaml [options]     run a case\n"
         "  quicksand check CASE.yaml [--set ..]  read and validate a case, print what would run\n"
         "  quicksand show CASE.yaml [--set ..]   print the case with every default filled in\n"
         "  quicksand show --explain [CASE | KEY] explain a case, a key (time.cfl), or a case to begin with\n"
         "  quicksand schema [--markdown]         print the JSON Schema of case files, or all keys as a page\n"
         "  quicksand info PATH                   print what a result folder, field file or checkpoint holds\n"
         "  quicksand --version                   print the versions of the program and its libraries\n"
         "  quicksand --help                      print this text\n"
         "\n"
         "options:\n"
         "  --set KEY.PATH=VALUE  replace a value of the case; repeatable, the last one wins\n"
         "                        (--set time.end=1 --set species.0.density=2 --set 'gravity=[0, 0, -9.81]')\n"
         "  --explain             with comments on every key: meaning, values, default, usual values\n"
         "  --strict              warnings of check count as bad input\n"
         "  --output DIR          write results to DIR instead of the case's output.directory\n"
         "  --overwrite           replace the results in an output folder that is not empty\n"
         "  --resume              go on from the last checkpoint in the output folder, to the same results\n"
         "  --threads N           number of threads\n"
         "  --quiet               no warnings, no progress\n"
         "\n"
         "exit codes: 0 finished, 2 bad input, 3 numerical failure, 4 input/output failure,\n"
         "            128 + signal where SIGINT or SIGTERM ended the run after a step, with a checkpoint written\n";
}

int execute(const CommandLine& line, std::ostream& out, std::ostream& err) {
  switch (line.command) {
    case Command::help: out << usage(); return 0;
    case Command::version: out << version_text(); return 0;
    case Command::schema: out << (line.markdown ? case_reference() : case_schema()); return 0;
    case Command::info: out << result_report(line.path); return 0;
    case Command::show: out << show(line); return 0;
    case Command::run: return run(line, err);
    case Command::check: break;
  }
  const CaseConfig config = read_case(line.path, line.settings);
  out << case_report(config);
  const std::vector<std::string> warnings = located_warnings(config, line.path, line.settings);
  for (const std::string& warning : warnings) out << "warning        " << warning << "\n";
  return line.strict && !warnings.empty() ? 2 : 0;
}

}  // namespace quicksand
