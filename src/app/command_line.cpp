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
#include "core/version.hpp"
#include "solvers/multigrid.hpp"

namespace quicksand {

namespace {

constexpr const char* see_help = " (see quicksand --help)";

constexpr int most_threads = 4096;

/// The command of that name. \throws InputError naming the nearest one
const CommandHelp& find_command(std::string word) {
  if (word == "-h" || word == "--help") word = "help";
  if (word == "--version") word = "version";
  std::vector<std::string> names;
  for (const CommandHelp& known : command_table()) {
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

void read_option(const std::string& argument, ArgumentReader& reader, const CommandHelp& command, CommandLine& line) {
  const std::size_t equals = argument.find('=');
  const std::string option = argument.substr(0, equals);
  const bool has_value = equals != std::string::npos;
  const std::optional<std::string> attached = has_value ? std::optional(argument.substr(equals + 1)) : std::nullopt;
  std::vector<std::string> known;
  for (const OptionHelp& taken : command.options) known.emplace_back(taken.name);
  if (std::find(known.begin(), known.end(), option) == known.end()) {
    const std::string list = known.empty() ? "; it takes no options" : "; allowed are " + join(known);
    throw InputError("unknown option " + option + " for '" + command.name + "'" + suggestion(option, known) + list);
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
    const std::pair<const char*, bool*> flags[] = {{"--overwrite", &line.overwrite},
                                                   {"--resume", &line.run.resume},
                                                   {"--quiet", &line.run.quiet},
                                                   {"--explain", &line.explain},
                                                   {"--markdown", &line.markdown},
                                                   {"--strict", &line.strict},
                                                   {"--fixed-threads", &line.run.fixed_threads}};
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
  const CommandHelp& command = find_command(arguments.front());
  line.command = command.command;
  ArgumentReader reader(arguments, 1);
  bool options_end = false;
  while (!reader.done()) {
    const std::string argument = reader.take();
    if (!options_end && argument == "--") {
      options_end = true;
    } else if (!options_end && (argument == "--help" || argument == "-h")) {
      CommandLine help;
      if (command.command != Command::help) help.path = command.name;
      return help;
    } else if (!options_end && argument.size() > 1 && argument.front() == '-') {
      read_option(argument, reader, command, line);
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
  if (command.operand_required && line.path.empty() && !line.explain) {
    throw InputError(std::string("'") + command.name + "' needs " + command.operand_meaning + see_help);
  }
  if (line.command == Command::help && !line.path.empty()) find_command(line.path);
  return line;
}

int execute(const CommandLine& line, std::ostream& out, std::ostream& err) {
  switch (line.command) {
    case Command::help: out << (line.path.empty() ? general_help() : command_help(find_command(line.path))); return 0;
    case Command::manual: out << manual_page(); return 0;
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
