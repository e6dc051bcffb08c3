#pragma once
/// \file
/// A configuration as a tree of scalars, lists and mappings that knows where every value came from.
#include <string>
#include <string_view>
#include <vector>

#include "core/text_output.hpp"

namespace quicksand {

/// Where something stands in the input: a file with line and column (from 1), or a command line option (line 0).
struct Place {
  std::string source;
  int line = 0;
  int column = 0;
};

/// `source:line:column`, or only the source where there is no line.
std::string to_string(const Place& place);

/// One value of a configuration with its key, its path from the root and its places.
struct ConfigNode {
  enum class Kind { none, scalar, list, map };

  Kind kind = Kind::none;
  std::string text;                  ///< of a scalar, as written
  bool quoted = false;               ///< scalar was quoted, so it is text even if it looks like a number
  std::vector<ConfigNode> children;  ///< items of a list, values of a mapping
  std::string key;                   ///< name in the mapping that holds this node; empty for list items and the root
  std::string path;                  ///< e.g. `species[0].rheology.law`
  Place place;                       ///< of the value
  Place key_place;                   ///< of the key; of the value where there is no key

  /// Value of a mapping's key, or null.
  const ConfigNode* find(std::string_view name) const;
  ConfigNode* find(std::string_view name);
  /// Adds a key to a mapping.
  ConfigNode& add(std::string name, ConfigNode value);
};

ConfigNode make_number(double value);
ConfigNode make_integer(long long value);
ConfigNode make_flag(bool value);
ConfigNode make_text(std::string text);
ConfigNode make_list(std::vector<ConfigNode> items = {});
ConfigNode make_map();

/// Path of a child: `parent.key` or `parent[index]`.
std::string child_path(const std::string& parent, const std::string& key);
std::string child_path(const std::string& parent, std::size_t index);

/// Shortest decimal text that reads back to the same double.
std::string shortest(double value);

/// YAML text of a mapping; reads back to the same tree.
std::string to_yaml(const ConfigNode& root);
/// A value as YAML on one line, `{a: 1, b: [2, 3]}`.
std::string to_yaml_line(const ConfigNode& node);
/// The same tree in JSON; scalars that are not quoted must be numbers, true or false.
Json to_json(const ConfigNode& node);

}  // namespace quicksand
