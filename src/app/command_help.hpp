#pragma once
/// \file
/// What the program's commands and options are called and what is said about them: the one source of what is read from
/// the command line, of `--help` and of the manual page. Shell completion reads `--help`.
#include <string>
#include <vector>

namespace quicksand {

enum class Command { run, check, show, schema, info, manual, version, help };

struct OptionHelp {
  const char* name;   ///< with its dashes
  const char* value;  ///< what stands for its value, or null where it has none
  const char* text;
};

struct CommandHelp {
  Command command;
  const char* name;
  const char* operand;          ///< what stands for its argument, or null where it has none
  const char* operand_meaning;  ///< the same in words
  bool operand_required;
  const char* summary;
  const char* text;
  std::vector<OptionHelp> options;
  std::vector<const char*> examples;  ///< arguments after the program's name
};

/// All commands, in the order in which help lists them.
const std::vector<CommandHelp>& command_table();

/// The program's help.
std::string general_help();
/// Help on one command.
std::string command_help(const CommandHelp& command);
/// The manual page, for troff with the `man` macros.
std::string manual_page();

}  // namespace quicksand
