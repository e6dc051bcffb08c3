#include "core/config_node.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

namespace quicksand {

namespace {

/// Longest line that a mapping or list may fill in flow style, `{a: 1, b: 2}`.
constexpr std::size_t flow_width = 110;

/// Text within double quotes, valid in JSON and YAML.
std::string quote(std::string_view text) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string out = "\"";
  for (const char ch : text) {
    const auto byte = static_cast<unsigned char>(ch);
    if (ch == '"' || ch == '\\') {
      out += '\\';
      out += ch;
    } else if (ch == '\n') {
      out += "\\n";
    } else if (ch == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += "\\u00";
      out += hex[byte >> 4];
      out += hex[byte & 15];
    } else {
      out += ch;
    }
  }
  return out + '"';
}

/// Whether YAML reads the text unquoted as the same string, inside flow collections too.
bool is_plain_text(std::string_view text) {
  constexpr std::string_view reserved[] = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"};
  if (text.empty() || text.back() == ' ') return false;
  if (!std::isalpha(static_cast<unsigned char>(text.front())) && text.front() != '_') return false;
  std::string lower;
  for (const char ch : text) {
    const auto byte = static_cast<unsigned char>(ch);
    if (!std::isalnum(byte) && std::string_view(" _-/.()+=;").find(ch) == std::string_view::npos) return false;
    lower += static_cast<char>(std::tolower(byte));
  }
  return std::find(std::begin(reserved), std::end(reserved), lower) == std::end(reserved);
}

std::string yaml_scalar(const ConfigNode& node) {
  return !node.quoted || is_plain_text(node.text) ? node.text : quote(node.text);
}

std::string yaml_flow(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::scalar) return yaml_scalar(node);
  const bool map = node.kind == ConfigNode::Kind::map;
  std::string out = map ? "{" : "[";
  for (const ConfigNode& child : node.children) {
    if (&child != &node.children.front()) out += ", ";
    if (map) out += child.key + ": ";
    out += yaml_flow(child);
  }
  return out + (map ? "}" : "]");
}

/// Whether a child is written on the line of its key. The root's larger mappings and its lists of mappings are not,
/// even where they would fit.
bool fits_on_line(const ConfigNode& child, bool in_root, std::size_t indent) {
  if (child.kind == ConfigNode::Kind::scalar || child.children.empty()) return true;
  if (in_root && child.kind == ConfigNode::Kind::map && child.children.size() > 2) return false;
  if (in_root && child.children.front().kind == ConfigNode::Kind::map) return false;
  return indent + child.key.size() + yaml_flow(child).size() < flow_width;
}

void yaml_block(const ConfigNode& node, std::size_t indent, std::string& out) {
  const std::string blanks(indent, ' ');
  for (const ConfigNode& child : node.children) {
    const bool item = node.kind == ConfigNode::Kind::list;
    out += blanks + (item ? "-" : child.key + ":");
    if (fits_on_line(child, indent == 0, indent)) {
      out += " " + yaml_flow(child) + "\n";
      continue;
    }
    std::string block;
    yaml_block(child, indent + 2, block);
    // An item's first key stands on the line of its dash.
    out += item ? block.substr(indent + 1) : "\n" + block;
  }
}

ConfigNode make_scalar(std::string text, bool quoted) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::scalar;
  node.text = std::move(text);
  node.quoted = quoted;
  return node;
}

}  // namespace

std::string to_string(const Place& place) {
  if (place.line == 0) return place.source;
  return place.source + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

const ConfigNode* ConfigNode::find(std::string_view name) const {
  if (kind != Kind::map) return nullptr;
  const auto found =
      std::find_if(children.begin(), children.end(), [&](const ConfigNode& child) { return child.key == name; });
  return found == children.end() ? nullptr : &*found;
}

ConfigNode* ConfigNode::find(std::string_view name) { return const_cast<ConfigNode*>(std::as_const(*this).find(name)); }

ConfigNode& ConfigNode::add(std::string name, ConfigNode value) {
  kind = Kind::map;
  value.key = std::move(name);
  children.push_back(std::move(value));
  return children.back();
}

ConfigNode make_number(double value) { return make_scalar(shortest(value), false); }
ConfigNode make_integer(long long value) { return make_scalar(std::to_string(value), false); }
ConfigNode make_flag(bool value) { return make_scalar(value ? "true" : "false", false); }
ConfigNode make_text(std::string text) { return make_scalar(std::move(text), true); }

ConfigNode make_list(std::vector<ConfigNode> items) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::list;
  node.children = std::move(items);
  return node;
}

ConfigNode make_map() {
  ConfigNode node;
  node.kind = ConfigNode::Kind::map;
  return node;
}

std::string child_path(const std::string& parent, const std::string& key) {
  return parent.empty() ? key : parent + "." + key;
}

std::string child_path(const std::string& parent, std::size_t index) {
  return parent + "[" + std::to_string(index) + "]";
}

std::string shortest(double value) {
  char buffer[32];
  const auto result = std::to_chars(std::begin(buffer), std::end(buffer), value);
  std::string text(buffer, result.ptr);
  // YAML 1.1 readers take 5e-04 for text: they need the point.
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos) text.insert(exponent, ".0");
  return text;
}

std::string to_yaml(const ConfigNode& root) {
  std::string out;
  yaml_block(root, 0, out);
  return out;
}

std::string to_yaml_line(const ConfigNode& node) { return yaml_flow(node); }

Json to_json(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::none: return {};
    case ConfigNode::Kind::scalar: break;
    case ConfigNode::Kind::list: {
      Json array = Json::array();
      for (const ConfigNode& child : node.children) array.append(to_json(child));
      return array;
    }
    case ConfigNode::Kind::map: {
      Json object = Json::object();
      for (const ConfigNode& child : node.children) object[child.key] = to_json(child);
      return object;
    }
  }
  if (node.quoted) return node.text;
  if (node.text == "true" || node.text == "false") return node.text == "true";
  if (node.text.find_first_of(".e") == std::string::npos) return std::stoll(node.text);
  double number = 0;
  std::from_chars(node.text.data(), node.text.data() + node.text.size(), number);
  return number;
}

}  // namespace quicksand
