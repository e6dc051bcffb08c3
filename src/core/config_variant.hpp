#pragma once
/// \file
/// Codecs of variants: mappings told apart by the word under a tag key, `{law: newtonian, viscosity: 1}`, or by their
/// only key, `{sphere: {radius: 1}}`.
#include <variant>

#include "core/config_codec.hpp"

namespace quicksand {

/// One alternative of a variant V: a mapping of members under a name.
template <class V>
struct Alternative {
  std::string name;
  KeyHelp help;
  /// Reads the members; `tag` is a key of the mapping to pass over.
  std::function<void(Reading&, const ConfigNode&, const std::string& tag, V&)> read;
  /// The mapping, or nothing if the variant holds another alternative.
  std::function<std::optional<ConfigNode>(const V&)> write;
  ConfigNode schema;
};

/// The alternative T of the variant V.
template <class V, class T>
Alternative<V> alternative(std::string name, std::vector<detail::MemberOf<T>> members, KeyHelp help) {
  const Codec<T> codec = object(members);
  Alternative<V> result{{}, std::move(help), {}, {}, codec.schema};
  result.read = [name, members](Reading& reading, const ConfigNode& node, const std::string& tag, V& out) {
    if (!detail::expect(reading, node, ConfigNode::Kind::map)) return;
    T value{};
    detail::read_members(reading, node, value, members, tag, name);
    out = value;
  };
  result.write = [codec](const V& value) {
    const T* held = std::get_if<T>(&value);
    return held != nullptr ? std::optional<ConfigNode>(codec.write(*held)) : std::nullopt;
  };
  result.name = std::move(name);
  return result;
}

namespace detail {

template <class V>
std::vector<std::string> names_of(const std::vector<Alternative<V>>& alternatives) {
  std::vector<std::string> names;
  for (const auto& alternative : alternatives) names.push_back(alternative.name);
  return names;
}

template <class V>
const Alternative<V>* find_alternative(const std::vector<Alternative<V>>& alternatives, const std::string& name) {
  for (const auto& alternative : alternatives) {
    if (alternative.name == name) return &alternative;
  }
  return nullptr;
}

}  // namespace detail

/// A variant as a mapping whose key `tag` names the alternative and whose other keys are its members.
template <class V>
Codec<V> tagged(std::string tag, std::vector<Alternative<V>> alternatives) {
  Codec<V> codec;
  std::vector<ConfigNode> schemas;
  for (const auto& alternative : alternatives) {
    ConfigNode schema = alternative.schema;
    detail::add_property(schema, tag, alternative.help, true, detail::word_schema(alternative.name), std::nullopt);
    schemas.push_back(std::move(schema));
  }
  codec.schema = detail::one_of(std::move(schemas));
  codec.read = [tag, alternatives](Reading& reading, const ConfigNode& node, V& out) {
    if (!detail::expect(reading, node, ConfigNode::Kind::map)) return;
    const std::vector<std::string> names = detail::names_of(alternatives);
    const ConfigNode* word = node.find(tag);
    if (word == nullptr) {
      detail::missing_key(reading, node, tag, "one of " + join(names));
      return;
    }
    const Alternative<V>* found = detail::find_alternative(alternatives, word->text);
    if (found == nullptr || word->kind != ConfigNode::Kind::scalar) {
      detail::wrong_word(reading, *word, names);
    } else {
      found->read(reading, node, tag, out);
    }
  };
  codec.write = [tag, alternatives](const V& value) {
    ConfigNode map = make_map();
    for (const auto& alternative : alternatives) {
      std::optional<ConfigNode> members = alternative.write(value);
      if (!members) continue;
      map.add(tag, make_text(alternative.name));
      for (ConfigNode& member : members->children) map.children.push_back(std::move(member));
    }
    return map;
  };
  return codec;
}

/// A variant as a mapping with one key, the name of the alternative, that holds its members.
template <class V>
Codec<V> keyed(std::vector<Alternative<V>> alternatives) {
  Codec<V> codec;
  std::vector<ConfigNode> schemas;
  for (const auto& alternative : alternatives) {
    ConfigNode schema = detail::object_schema();
    detail::add_property(schema, alternative.name, alternative.help, true, alternative.schema, std::nullopt);
    schemas.push_back(std::move(schema));
  }
  codec.schema = detail::one_of(std::move(schemas));
  codec.read = [alternatives](Reading& reading, const ConfigNode& node, V& out) {
    if (!detail::expect(reading, node, ConfigNode::Kind::map)) return;
    const std::vector<std::string> names = detail::names_of(alternatives);
    if (node.children.size() != 1) reading.problem(node, "must have exactly one key, one of " + join(names));
    for (const ConfigNode& entry : node.children) {
      const Alternative<V>* found = detail::find_alternative(alternatives, entry.key);
      if (found == nullptr) {
        detail::unknown_key(reading, entry, names, {});
      } else {
        found->read(reading, entry, {}, out);
      }
    }
  };
  codec.write = [alternatives](const V& value) {
    ConfigNode map = make_map();
    for (const auto& alternative : alternatives) {
      if (std::optional<ConfigNode> members = alternative.write(value)) map.add(alternative.name, std::move(*members));
    }
    return map;
  };
  return codec;
}

}  // namespace quicksand
