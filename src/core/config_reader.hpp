#pragma once
/// \file
/// Reading YAML into a ConfigNode tree. The only unit that uses the YAML library.
#include <string>
#include <vector>

#include "core/config_node.hpp"

namespace quicksand {

/// Something wrong in a configuration.
struct ConfigProblem {
  Place place;
  std::string path;  ///< of the key concerned; may be empty
  std::string message;
  bool spoils_value = true;  ///< false: the rest of what the path names can still be used (unknown or repeated key)
};

/// A parsed configuration; `problems` are those found on the way that did not stop the parsing (duplicate keys).
struct ConfigDocument {
  ConfigNode root;
  std::vector<ConfigProblem> problems;
};

/// Parses YAML text.
/// \param source  name of the text in messages
/// \throws InputError on invalid syntax, with line and column
ConfigDocument parse_yaml(const std::string& text, const std::string& source);

/// Reads a YAML file.
/// \throws InputError if the file is missing, unreadable, a folder, or not valid YAML
ConfigDocument read_yaml_file(const std::string& file);

/// Applies `KEY.PATH=VALUE`: replaces the value at the path, or adds its last keys. List elements are named by their
/// index, `species.0.density` or `species[0].density`; the value is YAML. A wrong setting becomes a problem.
void apply_setting(ConfigDocument& document, const std::string& setting);

/// All problems in one text, one line `file:line:column: key.path: message` each, in the order of the file.
std::string list_problems(std::vector<ConfigProblem> problems);

}  // namespace quicksand
