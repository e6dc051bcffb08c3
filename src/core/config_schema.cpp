#include "core/config_schema.hpp"

#include <charconv>

#include "core/config_reader.hpp"

namespace quicksand {

namespace {

/// Marks words as text, which in YAML need no quotes.
void quote_words(ConfigNode& node) {
  for (ConfigNode& child : node.children) quote_words(child);
  const char* end = node.text.data() + node.text.size();
  double number = 0;
  const bool is_number = std::from_chars(node.text.data(), end, number).ptr == end;
  if (node.kind == ConfigNode::Kind::scalar && !is_number && node.text != "true" && node.text != "false") {
    node.quoted = true;
  }
}

ConfigNode example_node(const std::string& text) {
  ConfigNode node = parse_yaml(text, "example").root;
  quote_words(node);
  return node;
}

}  // namespace

ConfigNode plain_schema(const ConfigNode& schema) {
  ConfigNode plain = schema;
  plain.children.clear();
  for (const ConfigNode& entry : schema.children) {
    if (!entry.key.starts_with("x-")) plain.children.push_back(plain_schema(entry));
  }
  const ConfigNode* typical = schema.find(schema_typical);
  if (typical != nullptr) plain.find("description")->text += ". Typical: " + typical->text;
  return plain;
}

namespace detail {

ConfigNode typed_schema(const std::string& type) {
  ConfigNode schema = make_map();
  schema.add("type", make_text(type));
  return schema;
}

ConfigNode quantity_schema(const Dimension& dimension, const Range& range) {
  ConfigNode schema = typed_schema("number");
  if (!(dimension == dimension::none)) {
    schema = make_map();
    schema.add("type", make_list({make_text("number"), make_text("string")}));
    schema.add("pattern", make_text(R"(^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?(\s*[A-Za-z1/].*)?\s*$)"));
  }
  if (range.low > any_number.low) {
    schema.add(range.low_excluded ? "exclusiveMinimum" : "minimum", make_number(range.low));
  }
  if (range.high < any_number.high) schema.add("maximum", make_number(range.high));
  schema.add(schema_value, make_text(quantity_in_si(dimension)));
  return schema;
}

ConfigNode object_schema() {
  ConfigNode schema = typed_schema("object");
  schema.add("properties", make_map());
  schema.add("required", make_list());
  schema.add("additionalProperties", make_flag(false));
  return schema;
}

void add_property(ConfigNode& object, const std::string& name, const KeyHelp& help, bool required, ConfigNode schema,
                  const std::optional<ConfigNode>& standard) {
  schema.add("description", make_text(help.meaning));
  if (!help.typical.empty()) schema.add(schema_typical, make_text(help.typical));
  if (!help.examples.empty()) {
    ConfigNode examples = make_list();
    for (const std::string& example : help.examples) examples.children.push_back(example_node(example));
    schema.add("examples", std::move(examples));
  }
  if (standard) schema.add("default", *standard);
  object.find("properties")->add(name, std::move(schema));
  if (required) object.find("required")->children.push_back(make_text(name));
}

ConfigNode list_schema(ConfigNode item, std::size_t least) {
  ConfigNode schema = typed_schema("array");
  schema.add("items", std::move(item));
  if (least > 0) schema.add("minItems", make_integer(static_cast<long long>(least)));
  return schema;
}

ConfigNode words_schema(const std::vector<std::string>& words) {
  ConfigNode schema = make_map();
  ConfigNode list = make_list();
  for (const std::string& word : words) list.children.push_back(make_text(word));
  schema.add("enum", std::move(list));
  return schema;
}

ConfigNode word_schema(const std::string& word) {
  ConfigNode schema = make_map();
  schema.add("const", make_text(word));
  return schema;
}

ConfigNode one_of(std::vector<ConfigNode> alternatives) {
  ConfigNode schema = make_map();
  schema.add("oneOf", make_list(std::move(alternatives)));
  return schema;
}

}  // namespace detail

}  // namespace quicksand
