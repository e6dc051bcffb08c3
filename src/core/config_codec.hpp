#pragma once
/// \file
/// Declarative description of a configuration. A Codec<T> tells at once how a value is read, written and described in
/// a JSON Schema, so that the three cannot drift apart. Codecs of structs are put together from codecs of members.
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/config_reader.hpp"
#include "core/index.hpp"
#include "core/units.hpp"

namespace quicksand {

/// What reading needs besides the values, and the problems found so far.
class Reading {
 public:
  explicit Reading(ConfigDocument document)
      : root_(std::move(document.root)), problems_(std::move(document.problems)) {}

  UnitSystem units = UnitSystem::si;
  int vector_length = 0;  ///< 2: vectors may be [x, z]; 3: [x, y, z]; 0: either

  const ConfigNode& root() const { return root_; }
  /// The node at a path, or the deepest of its ancestors that exists.
  const ConfigNode& nearest(const std::string& path) const;

  /// Notes a problem at a value.
  void problem(const ConfigNode& where, std::string message);
  /// Notes a problem at a path; the place is that of the value or, where it is missing, of the nearest ancestor.
  void problem(const std::string& path, std::string message);
  /// Notes a problem about a key rather than its value; the mapping that holds it stays usable.
  void key_problem(const ConfigNode& where, std::string message);

  /// Adds to the message of the problem noted last.
  void amend_last(const std::string& text) { problems_.back().message += text; }

  /// Whether no problem was found that spoils the value at the path: there, below it, or in a mapping that holds it.
  bool clean(const std::string& path) const;
  const std::vector<ConfigProblem>& problems() const { return problems_; }

 private:
  ConfigNode root_;
  std::vector<ConfigProblem> problems_;
};

/// What a key means: for messages, the schema, explanations and the reference.
struct KeyHelp {
  KeyHelp(const char* what, const char* usual = "", const std::vector<const char*>& written = {})
      : meaning(what), typical(usual), examples(written.begin(), written.end()) {}

  std::string meaning;                ///< one sentence without a full stop
  std::string typical;                ///< usual values and how to choose one; may be empty
  std::vector<std::string> examples;  ///< values as they are written in YAML
};

/// How a T is read (noting problems and leaving the value where it is wrong), written and described.
template <class T>
struct Codec {
  std::function<void(Reading&, const ConfigNode&, T&)> read;
  std::function<ConfigNode(const T&)> write;
  ConfigNode schema;
};

/// Allowed values of a number.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;

  bool contains(double x) const { return (low_excluded ? x > low : x >= low) && x <= high; }
};
inline constexpr Range any_number{};
inline constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range not_negative{0, std::numeric_limits<double>::infinity(), false};

/// A number with the given dimension, with or without a unit.
Codec<double> quantity(const Dimension& dimension, const Range& range = any_number);
Codec<int> whole_number(int least, int most = std::numeric_limits<int>::max());
Codec<bool> flag();
/// Any text.
Codec<std::string> text();
/// A name that can be part of a file's column or data set: letters, digits and underscores.
Codec<std::string> identifier();
/// [x, y, z], or [x, z] in two dimensions.
Codec<Vec<3>> vector_of(const Dimension& dimension);

/// Text in double quotes, for messages: 'text'.
std::string in_quotes(const std::string& text);
/// `a, b, c`.
std::string join(const std::vector<std::string>& words);
/// The word nearest in spelling, as `; did you mean 'x'?`, or nothing if none is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

namespace detail {

/// The part of a struct's member that does not depend on the member's type.
template <class S>
struct MemberOf {
  std::string name;
  KeyHelp help;
  bool required = false;
  std::function<void(Reading&, const ConfigNode&, S&)> read;
  std::function<std::optional<ConfigNode>(const S&)> write;
  ConfigNode schema;
};

bool expect(Reading& reading, const ConfigNode& node, ConfigNode::Kind kind);
std::string kind_name(const ConfigNode& node);
void unknown_key(Reading& reading, const ConfigNode& entry, const std::vector<std::string>& allowed,
                 const std::string& of);
void missing_key(Reading& reading, const ConfigNode& map, const std::string& name, const std::string& meaning);
void wrong_word(Reading& reading, const ConfigNode& node, const std::vector<std::string>& allowed);
ConfigNode object_schema();
void add_property(ConfigNode& object, const std::string& name, const KeyHelp& help, bool required, ConfigNode schema,
                  const std::optional<ConfigNode>& standard);
ConfigNode list_schema(ConfigNode item, std::size_t least);
ConfigNode words_schema(const std::vector<std::string>& words);
ConfigNode word_schema(const std::string& word);
ConfigNode one_of(std::vector<ConfigNode> alternatives);

template <class S>
std::vector<std::string> names_of(const std::vector<MemberOf<S>>& members) {
  std::vector<std::string> names;
  for (const auto& member : members) names.push_back(member.name);
  return names;
}

/// Reads the members of a mapping; `also` is a key that belongs to the mapping without being a member.
template <class S>
void read_members(Reading& reading, const ConfigNode& node, S& value, const std::vector<MemberOf<S>>& members,
                  const std::string& also = {}, const std::string& of = {}) {
  for (const ConfigNode& entry : node.children) {
    bool known = entry.key == also;
    for (const auto& member : members) {
      if (member.name != entry.key) continue;
      member.read(reading, entry, value);
      known = true;
    }
    if (known) continue;
    std::vector<std::string> allowed = names_of(members);
    if (!also.empty()) allowed.insert(allowed.begin(), also);
    unknown_key(reading, entry, allowed, of);
  }
  for (const auto& member : members) {
    if (member.required && node.find(member.name) == nullptr)
      missing_key(reading, node, member.name, member.help.meaning);
  }
}

template <class S>
void write_members(ConfigNode& map, const S& value, const std::vector<MemberOf<S>>& members) {
  for (const auto& member : members) {
    if (std::optional<ConfigNode> node = member.write(value)) map.add(member.name, std::move(*node));
  }
}

template <class S>
void describe_members(ConfigNode& schema, const std::vector<MemberOf<S>>& members) {
  const S standard{};
  for (const auto& member : members) {
    add_property(schema, member.name, member.help, member.required, member.schema,
                 member.required ? std::nullopt : member.write(standard));
  }
}

}  // namespace detail

/// A member whose key must be present.
template <class S, class T>
detail::MemberOf<S> required(std::string name, T S::*member, Codec<T> codec, KeyHelp help) {
  return {std::move(name),
          std::move(help),
          true,
          [member, read = codec.read](Reading& r, const ConfigNode& n, S& s) { read(r, n, s.*member); },
          [member, write = codec.write](const S& s) { return std::optional<ConfigNode>(write(s.*member)); },
          std::move(codec.schema)};
}

/// A member that keeps the value it has in a new S where its key is absent.
template <class S, class T>
detail::MemberOf<S> defaulted(std::string name, T S::*member, Codec<T> codec, KeyHelp help) {
  detail::MemberOf<S> result = required(std::move(name), member, std::move(codec), std::move(help));
  result.required = false;
  return result;
}

/// A member that may be absent, without a default.
template <class S, class T>
detail::MemberOf<S> maybe(std::string name, std::optional<T> S::*member, Codec<T> codec, KeyHelp help) {
  return {std::move(name),
          std::move(help),
          false,
          [member, read = codec.read](Reading& r, const ConfigNode& n, S& s) { read(r, n, (s.*member).emplace()); },
          [member, write = codec.write](const S& s) {
            return s.*member ? std::optional<ConfigNode>(write(*(s.*member))) : std::nullopt;
          },
          std::move(codec.schema)};
}

/// A member, a list, that is written only where it is not empty.
template <class S, class T>
detail::MemberOf<S> maybe(std::string name, std::vector<T> S::*member, Codec<std::vector<T>> codec, KeyHelp help) {
  detail::MemberOf<S> result = defaulted(std::move(name), member, codec, std::move(help));
  result.write = [member, write = codec.write](const S& s) {
    return (s.*member).empty() ? std::nullopt : std::optional<ConfigNode>(write(s.*member));
  };
  return result;
}

/// The codec with a name for what it describes. Where it is used again, explanations refer to the first use.
template <class T>
Codec<T> named(const char* name, Codec<T> codec) {
  codec.schema.add("title", make_text(name));
  return codec;
}

/// A mapping with the members of a struct.
template <class S>
Codec<S> object(std::vector<detail::MemberOf<S>> members) {
  Codec<S> codec;
  codec.schema = detail::object_schema();
  detail::describe_members(codec.schema, members);
  const auto shared = std::make_shared<const std::vector<detail::MemberOf<S>>>(std::move(members));
  codec.read = [shared](Reading& reading, const ConfigNode& node, S& value) {
    if (detail::expect(reading, node, ConfigNode::Kind::map)) detail::read_members(reading, node, value, *shared);
  };
  codec.write = [shared](const S& value) {
    ConfigNode map = make_map();
    detail::write_members(map, value, *shared);
    return map;
  };
  return codec;
}

/// One word out of several.
template <class E>
Codec<E> choice(std::vector<std::pair<std::string, E>> values) {
  std::vector<std::string> words;
  for (const auto& [word, value] : values) words.push_back(word);
  Codec<E> codec;
  codec.schema = detail::words_schema(words);
  codec.read = [values, words](Reading& reading, const ConfigNode& node, E& out) {
    for (const auto& [word, value] : values) {
      if (node.kind == ConfigNode::Kind::scalar && node.text == word) {
        out = value;
        return;
      }
    }
    detail::wrong_word(reading, node, words);
  };
  codec.write = [values](const E& value) {
    for (const auto& [word, candidate] : values) {
      if (candidate == value) return make_text(word);
    }
    return make_text("");
  };
  return codec;
}

/// A list of at least `least` items.
template <class T>
Codec<std::vector<T>> list_of(Codec<T> item, std::size_t least = 0) {
  Codec<std::vector<T>> codec;
  codec.schema = detail::list_schema(item.schema, least);
  codec.read = [item, least](Reading& reading, const ConfigNode& node, std::vector<T>& out) {
    if (!detail::expect(reading, node, ConfigNode::Kind::list)) return;
    if (node.children.size() < least) {
      reading.problem(node, "needs at least " + std::to_string(least) + (least == 1 ? " item" : " items"));
    }
    out.clear();
    for (const ConfigNode& child : node.children) item.read(reading, child, out.emplace_back());
  };
  codec.write = [item](const std::vector<T>& values) {
    ConfigNode list = make_list();
    for (const T& value : values) list.children.push_back(item.write(value));
    return list;
  };
  return codec;
}

/// One item, or a list of items.
template <class T>
Codec<std::vector<T>> one_or_list_of(Codec<T> item) {
  const Codec<std::vector<T>> list = list_of(item, 1);
  Codec<std::vector<T>> codec;
  codec.schema = detail::one_of({item.schema, list.schema});
  codec.read = [item, list](Reading& reading, const ConfigNode& node, std::vector<T>& out) {
    if (node.kind == ConfigNode::Kind::list) {
      list.read(reading, node, out);
    } else {
      out.resize(1);
      item.read(reading, node, out.front());
    }
  };
  codec.write = [item, list](const std::vector<T>& values) {
    return values.size() == 1 ? item.write(values.front()) : list.write(values);
  };
  return codec;
}

}  // namespace quicksand
