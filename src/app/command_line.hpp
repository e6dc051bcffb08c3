#pragma once
/// \file
/// The program's commands and options.
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "app/command_help.hpp"
#include "app/run.hpp"

namespace quicksand {

/// What the user asked for.
struct CommandLine {
  Command command = Command::help;
  std::string path;                   ///< case file, for info a result folder or field file, for help a command
  std::vector<std::string> settings;  ///< of --set, in order
  std::optional<std::string> output;  ///< folder of the results instead of the case's
  bool explain = false;               ///< show with comments on every key, or a key in place of a case
  bool markdown = false;              ///< the schema as a page of reference
  bool strict = false;                ///< warnings of check count as bad input
  bool overwrite = false;             ///< replace results in the output folder
  RunOptions run;
};

/// Reads the arguments after the program's name.
/// \throws InputError on unknown commands and options, naming the nearest one
CommandLine parse_command_line(const std::vector<std::string>& arguments);

/// Does what the user asked for; text goes to `out`, warnings to `err`.
/// \return exit code of the program
/// \throws InputError, NumericalError, FileError
int execute(const CommandLine& line, std::ostream& out, std::ostream& err);

}  // namespace quicksand
