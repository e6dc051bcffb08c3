#pragma once
/// \file
/// The keys of a configuration as its schema describes them, for explanations and the reference.
#include <string>
#include <utility>
#include <vector>

#include "core/config_node.hpp"

namespace quicksand {

/// A key. The same path has several descriptions where alternatives have keys of the same name.
struct KeyDescription {
  std::string path;  ///< from the root, without the numbers of list items: `species.rheology.viscosity`
  std::string of;    ///< the alternative that it belongs to, such as `newtonian`; empty where there are no others
  std::string meaning;
  std::string typical;   ///< usual values; may be empty
  std::string value;     ///< what may be given, in words
  std::string standard;  ///< the default, in YAML; empty where there is none
  bool required = false;
  std::vector<std::string> examples;                       ///< in YAML
  std::vector<std::pair<std::string, std::string>> words;  ///< of a key that chooses an alternative, with meanings
  std::string same_as;  ///< path of an earlier key that takes the same; the keys below it are listed there only
};

/// What a schema lets one choose from: the members of its `oneOf`, or the schema alone.
std::vector<const ConfigNode*> alternatives_of(const ConfigNode& schema);

/// The word that tells a mapping from its alternatives (`law: newtonian`), as the schema of its key; null without one.
const ConfigNode* tag_of(const ConfigNode& schema);

/// What may be given, in words: `length in m, > 0`.
std::string value_text(const ConfigNode& schema);

/// The description of a single key, from the schema of its value.
KeyDescription describe_key(const std::string& path, const ConfigNode& schema, bool required);

/// All keys, in the order of the schema.
std::vector<KeyDescription> list_keys(const ConfigNode& schema);

/// Those that a user may mean by `path`: the key itself, which may have numbers of list items in it
/// (`species[0].name`), or else every key whose path ends like that.
std::vector<KeyDescription> find_keys(const std::vector<KeyDescription>& keys, const std::string& path);

}  // namespace quicksand
