#include "core/config_keys.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>

#include "core/config_codec.hpp"
#include "core/config_schema.hpp"

namespace quicksand {

namespace {

std::string text_of(const ConfigNode& schema, const char* keyword) {
  const ConfigNode* node = schema.find(keyword);
  return node != nullptr ? node->text : "";
}

/// `, > 0, <= 1`, or `, 2 to 3`
std::string range_text(const ConfigNode& schema) {
  const ConfigNode* least = schema.find("minimum");
  const ConfigNode* most = schema.find("maximum");
  if (least != nullptr && most != nullptr) return ", " + least->text + " to " + most->text;
  constexpr std::pair<const char*, const char*> limits[] = {
      {"minimum", ">= "}, {"exclusiveMinimum", "> "}, {"maximum", "<= "}};
  std::string text;
  for (const auto& [keyword, sign] : limits) {
    if (const ConfigNode* limit = schema.find(keyword)) text += std::string(", ") + sign + limit->text;
  }
  return text;
}

std::string type_text(const ConfigNode& schema) {
  std::string type = text_of(schema, "type");
  if (type == "integer") return "whole number";
  if (type == "boolean") return "true or false";
  if (type == "string") return "text";
  if (type == "object") return "mapping";
  const ConfigNode* items = schema.find("items");
  if (items == nullptr) return type;
  const std::string item = value_text(*items);
  return item == "mapping" ? "list of mappings" : "list, each item a " + item;
}

bool holds_mapping(const ConfigNode& schema) {
  const auto all = alternatives_of(schema);
  return std::any_of(all.begin(), all.end(), [](const ConfigNode* alternative) {
    const ConfigNode* items = alternative->find("items");
    return alternative->find("properties") != nullptr || (items != nullptr && holds_mapping(*items));
  });
}

/// Walks over a schema and lists its keys.
class KeyLister {
 public:
  std::vector<KeyDescription> keys;

  void visit(const ConfigNode& schema, const std::string& path, const std::string& of) {
    const auto all = alternatives_of(schema);
    const auto mappings = std::count_if(all.begin(), all.end(), [](const ConfigNode* alternative) {
      return alternative->find("properties") != nullptr;
    });
    for (const ConfigNode* alternative : all) {
      if (const ConfigNode* items = alternative->find("items")) visit(*items, path, of);
      if (alternative->find("properties") != nullptr) visit_mapping(*alternative, path, of, mappings > 1);
    }
  }

 private:
  void visit_mapping(const ConfigNode& schema, const std::string& path, const std::string& outer, bool is_choice) {
    const ConfigNode* tag = tag_of(schema);
    const std::string of = tag != nullptr ? text_of(*tag, "const") : outer;
    if (tag != nullptr) add_word(*tag, child_path(path, tag->key), outer);
    const auto& required = schema.find("required")->children;
    for (const ConfigNode& property : schema.find("properties")->children) {
      if (&property == tag) continue;
      const std::string name = child_path(path, property.key);
      if (find(name, of) != nullptr) continue;
      const bool needed = std::any_of(required.begin(), required.end(),
                                      [&](const ConfigNode& word) { return word.text == property.key; });
      // A key that is itself the choice is not required, some other may be given.
      keys.push_back(describe_key(name, property, needed && (tag != nullptr || !is_choice)));
      keys.back().of = of;
      const std::string title = text_of(property, "title");
      if (!title.empty() && !first_.emplace(title, name).second) {
        keys.back().same_as = first_.at(title);
      } else {
        visit(property, name, of);
      }
    }
  }

  void add_word(const ConfigNode& tag, const std::string& path, const std::string& of) {
    KeyDescription* key = find(path, of);
    if (key == nullptr) {
      keys.push_back({path, of, "which one of these it is", "", "one of the words below", "", true, {}, {}, ""});
      key = &keys.back();
    }
    key->words.emplace_back(text_of(tag, "const"), text_of(tag, "description"));
  }

  KeyDescription* find(const std::string& path, const std::string& of) {
    const auto found = std::find_if(keys.begin(), keys.end(),
                                    [&](const KeyDescription& key) { return key.path == path && key.of == of; });
    return found != keys.end() ? &*found : nullptr;
  }

  std::map<std::string, std::string> first_;  ///< where a named schema was met first
};

/// A path without the numbers of list items: of `species[0].name` and `species.0.name`, `species.name`.
std::string without_numbers(const std::string& path) {
  std::string text;
  std::string part;
  for (const char ch : path + ".") {
    if (ch != '.' && ch != '[' && ch != ']') {
      part += ch;
      continue;
    }
    const bool number = std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c); });
    if (!number) text = child_path(text, part);
    part.clear();
  }
  return text;
}

}  // namespace

std::vector<const ConfigNode*> alternatives_of(const ConfigNode& schema) {
  const ConfigNode* choices = schema.find("oneOf");
  if (choices == nullptr) return {&schema};
  std::vector<const ConfigNode*> all;
  for (const ConfigNode& choice : choices->children) all.push_back(&choice);
  return all;
}

const ConfigNode* tag_of(const ConfigNode& schema) {
  const ConfigNode* properties = schema.find("properties");
  if (properties == nullptr) return nullptr;
  const auto found = std::find_if(properties->children.begin(), properties->children.end(),
                                  [](const ConfigNode& property) { return property.find("const") != nullptr; });
  return found != properties->children.end() ? &*found : nullptr;
}

std::string value_text(const ConfigNode& schema) {
  std::string text = text_of(schema, schema_value);
  if (!text.empty()) return text + range_text(schema);
  if (const ConfigNode* words = schema.find("enum")) {
    std::vector<std::string> list;
    for (const ConfigNode& word : words->children) list.push_back(word.text);
    return "one of " + join(list);
  }
  if (schema.find("oneOf") == nullptr) return type_text(schema) + range_text(schema);
  std::vector<std::string> known;
  for (const ConfigNode* alternative : alternatives_of(schema)) {
    const std::string kind = value_text(*alternative);
    if (std::find(known.begin(), known.end(), kind) != known.end()) continue;
    known.push_back(kind);
    text += (text.empty() ? "" : "; or ") + kind;
  }
  return text;
}

KeyDescription describe_key(const std::string& path, const ConfigNode& schema, bool required) {
  KeyDescription key{
      path, {}, text_of(schema, "description"), text_of(schema, schema_typical), value_text(schema), {}, required, {},
      {},   {}};
  const ConfigNode* standard = schema.find("default");
  // Defaults of mappings are those of their keys.
  if (standard != nullptr && !(standard->kind == ConfigNode::Kind::map && holds_mapping(schema))) {
    key.standard = to_yaml_line(*standard);
  }
  if (const ConfigNode* examples = schema.find("examples")) {
    for (const ConfigNode& example : examples->children) {
      // As it is written by hand: quantities need no quotes.
      key.examples.push_back(to_yaml_line(example));
      std::erase(key.examples.back(), '"');
    }
  }
  return key;
}

std::vector<KeyDescription> list_keys(const ConfigNode& schema) {
  KeyLister lister;
  lister.visit(schema, {}, {});
  return std::move(lister.keys);
}

std::vector<KeyDescription> find_keys(const std::vector<KeyDescription>& keys, const std::string& path) {
  const std::string wanted = without_numbers(path);
  if (wanted.empty()) return {};
  std::vector<KeyDescription> found;
  const auto take = [&](auto&& fits) { std::copy_if(keys.begin(), keys.end(), std::back_inserter(found), fits); };
  take([&](const KeyDescription& key) { return key.path == wanted; });
  for (const KeyDescription& key : keys) {
    if (!found.empty() || key.same_as.empty() || !wanted.starts_with(key.path + ".")) continue;
    const std::string first = key.same_as + wanted.substr(key.path.size());
    take([&](const KeyDescription& other) { return other.path == first; });
  }
  if (found.empty()) take([&](const KeyDescription& key) { return key.path.ends_with("." + wanted); });
  return found;
}

}  // namespace quicksand
