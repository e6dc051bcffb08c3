#include "core/config_explanation.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include "core/config_codec.hpp"
#include "core/config_schema.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Width to which text is broken.
constexpr std::size_t text_width = 100;

/// Appends words, broken to lines that begin with `first`, later ones with `rest`.
void append_wrapped(std::string& out, const std::string& text, const std::string& first, const std::string& rest) {
  std::string line = first;
  bool empty = true;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!empty && line.size() + 1 + word.size() > text_width) {
      out += line + "\n";
      line = rest;
      empty = true;
    }
    line += (empty ? "" : " ") + word;
    empty = false;
  }
  out += line + "\n";
}

/// All that is known of a key in one paragraph.
std::string paragraph(const KeyDescription& key) {
  std::vector<std::string> facts;
  if (key.value != "mapping") facts.push_back(key.value);
  if (!key.standard.empty()) facts.push_back("default " + key.standard);
  if (key.required) facts.emplace_back("required");
  std::string text = key.meaning;
  for (const std::string& fact : facts) text += (&fact == &facts.front() ? " [" : "; ") + fact;
  if (!facts.empty()) text += "]";
  if (!key.typical.empty()) text += " Typical: " + key.typical;
  return text;
}

/// Whether a value has the form of a schema, judged by what tells alternatives apart.
bool has_form(const ConfigNode& value, const ConfigNode& schema) {
  const ConfigNode* properties = schema.find("properties");
  if (value.kind == ConfigNode::Kind::list) return schema.find("items") != nullptr;
  if (value.kind != ConfigNode::Kind::map) return properties == nullptr && schema.find("items") == nullptr;
  if (properties == nullptr) return false;
  return std::all_of(value.children.begin(), value.children.end(), [&](const ConfigNode& child) {
    const ConfigNode* property = properties->find(child.key);
    if (property == nullptr) return false;
    const ConfigNode* word = property->find("const");
    return word == nullptr || word->text == child.text;
  });
}

const ConfigNode& form_of(const ConfigNode& value, const ConfigNode& schema) {
  for (const ConfigNode* alternative : alternatives_of(schema)) {
    if (has_form(value, *alternative)) return *alternative;
  }
  return schema;
}

/// Whether a value is written on the line of its key.
bool is_short(const ConfigNode& value) {
  if (value.kind == ConfigNode::Kind::map) return value.children.empty();
  return std::none_of(value.children.begin(), value.children.end(),
                      [](const ConfigNode& child) { return child.kind == ConfigNode::Kind::map; });
}

class Explainer {
 public:
  explicit Explainer(bool forms) : forms_(forms) {}

  void write_mapping(const ConfigNode& value, const ConfigNode& schema, const std::string& path, std::size_t indent) {
    const ConfigNode& form = form_of(value, schema);
    const ConfigNode& properties = *form.find("properties");
    const ConfigNode* tag = tag_of(form);
    // Every alternative has keys of its own.
    const std::string place = tag != nullptr ? path + ":" + tag->find("const")->text : path;
    for (const ConfigNode& child : value.children) {
      write_key(child, *properties.find(child.key), child_path(place, child.key), indent);
    }
    for (const ConfigNode& property : properties.children) {
      if (value.find(property.key) != nullptr || !explained_.insert(child_path(place, property.key)).second) continue;
      outline(property, false, indent);
    }
    if (indent == 0) return;
    list_other_forms(form, schema, path, indent);
  }

  std::string take() { return std::move(out_); }

 private:
  void write_key(const ConfigNode& child, const ConfigNode& schema, const std::string& path, std::size_t indent) {
    const std::string blanks(indent, ' ');
    const bool is_first = explained_.insert(path).second;
    if (indent == 0 && !out_.empty()) out_ += "\n";
    if (is_first)
      comment(schema.find("const") != nullptr ? schema.find("description")->text
                                              : paragraph(describe_key({}, schema, false)),
              indent);
    // What was explained under another key with the same name is not explained again.
    const ConfigNode* title = schema.find("title");
    const std::string below = title != nullptr ? "<" + title->text + ">" : path;
    explained_.insert(below);
    out_ += blanks + child.key + ":";
    if (is_short(child)) {
      out_ += " " + to_yaml_line(child) + "\n";
      // Of an empty mapping what it may have.
      if (child.kind == ConfigNode::Kind::map) return write_mapping(child, schema, below, indent + 2);
      const ConfigNode& form = form_of(child, schema);
      if (child.kind != ConfigNode::Kind::list) list_other_forms(form, schema, below, indent + 2);
      if (child.kind == ConfigNode::Kind::list && child.children.empty()) list_items(form, below, indent + 2);
      return;
    }
    out_ += "\n";
    if (child.kind == ConfigNode::Kind::map) return write_mapping(child, schema, below, indent + 2);
    const ConfigNode& items = *form_of(child, schema).find("items");
    for (const ConfigNode& item : child.children) {
      const std::size_t begin = out_.size();
      write_mapping(item, items, below, indent + 4);
      // The first key of an item stands behind the dash, which takes the place of two blanks.
      std::size_t line = begin;
      while (out_[out_.find_first_not_of(' ', line)] == '#') line = out_.find('\n', line) + 1;
      out_[line + indent + 2] = '-';
    }
  }

  /// What the items of a list that is empty here may have.
  void list_items(const ConfigNode& schema, const std::string& path, std::size_t indent) {
    const ConfigNode* items = schema.find("items");
    if (items == nullptr || !explained_.insert(path + "[]").second) return;
    outline_below(*items, indent);
  }

  void list_other_forms(const ConfigNode& form, const ConfigNode& schema, const std::string& path, std::size_t indent) {
    if (!forms_ || !explained_.insert(path + "|forms").second) return;
    bool is_first = true;
    for (const ConfigNode* alternative : alternatives_of(schema)) {
      if (alternative == &form || alternative->find("properties") == nullptr) continue;
      if (is_first) comment("Other forms:", indent);
      is_first = false;
      outline_below(*alternative, indent);
    }
  }

  /// A key that is not given, with all below it.
  void outline(const ConfigNode& schema, bool required, std::size_t indent) {
    comment(schema.key + ": " + paragraph(describe_key({}, schema, required)), indent);
    const ConfigNode* title = schema.find("title");
    if (title != nullptr && !explained_.insert("<" + title->text + ">").second) return;
    outline_below(schema, indent + 2);
  }

  void outline_below(const ConfigNode& schema, std::size_t indent) {
    std::set<std::string> done;
    for (const ConfigNode* alternative : alternatives_of(schema)) {
      if (const ConfigNode* items = alternative->find("items"); items != nullptr && done.empty()) {
        outline_below(*items, indent);
      }
      const ConfigNode* properties = alternative->find("properties");
      if (properties == nullptr) continue;
      const ConfigNode* tag = tag_of(*alternative);
      if (tag != nullptr) {
        comment(tag->key + ": " + tag->find("const")->text + " - " + tag->find("description")->text, indent);
      }
      const auto& required = alternative->find("required")->children;
      for (const ConfigNode& property : properties->children) {
        if (&property == tag || (tag == nullptr && !done.insert(property.key).second)) continue;
        const bool needed = std::any_of(required.begin(), required.end(),
                                        [&](const ConfigNode& word) { return word.text == property.key; });
        outline(property, needed, indent + (tag != nullptr ? 2 : 0));
      }
    }
  }

  void comment(const std::string& text, std::size_t indent) {
    const std::string blanks(indent, ' ');
    append_wrapped(out_, text, blanks + "# ", blanks + "#   ");
  }

  bool forms_;
  std::set<std::string> explained_;
  std::string out_;
};

void append_entry(std::string& out, const std::string& name, const std::string& text) {
  if (text.empty()) return;
  constexpr std::size_t column = 12;
  const std::string first = "  " + name + std::string(name.size() + 2 < column ? column - name.size() - 2 : 1, ' ');
  append_wrapped(out, text, first, std::string(column, ' '));
}

std::string key_text(const KeyDescription& key, const std::vector<KeyDescription>& keys) {
  std::string out = key.path + (key.of.empty() ? "" : "  (" + key.of + ")") + "\n";
  append_wrapped(out, key.meaning, "  ", "  ");
  append_entry(out, "value", key.value);
  append_entry(out, "default", key.required ? "none, required" : key.standard.empty() ? "none" : key.standard);
  append_entry(out, "typical", key.typical);
  for (const std::string& example : key.examples) {
    append_entry(out, "example", key.path.substr(key.path.rfind('.') + 1) + ": " + example);
  }
  for (const auto& [word, meaning] : key.words) append_entry(out, word, meaning);
  const std::string above = (key.same_as.empty() ? key.path : key.same_as) + ".";
  bool is_first = true;
  for (const KeyDescription& other : keys) {
    if (!other.path.starts_with(above) || other.path.find('.', above.size()) != std::string::npos) continue;
    if (is_first) out += "  keys\n";
    is_first = false;
    append_wrapped(
        out,
        other.path.substr(above.size()) + ": " + (other.of.empty() ? "" : "(" + other.of + ") ") + paragraph(other),
        "    ", "      ");
  }
  return out;
}

}  // namespace

std::string explained_yaml(const ConfigNode& value, const ConfigNode& schema, bool forms) {
  Explainer explainer(forms);
  explainer.write_mapping(value, schema, {}, 0);
  return explainer.take();
}

std::string explain_keys(const ConfigNode& schema, const std::string& path) {
  const std::vector<KeyDescription> keys = list_keys(schema);
  const std::vector<KeyDescription> found = find_keys(keys, path);
  if (found.empty()) {
    std::vector<std::string> known;
    for (const KeyDescription& key : keys) {
      known.push_back(key.path);
      known.push_back(key.path.substr(key.path.rfind('.') + 1));
    }
    throw InputError(in_quotes(path) + " is no key of a case" + suggestion(path, known));
  }
  std::string out;
  for (const KeyDescription& key : found) out += (out.empty() ? "" : "\n") + key_text(key, keys);
  return out;
}

std::string reference_page(const ConfigNode& schema) {
  const auto in_cell = [](std::string text) {
    for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
    return text;
  };
  const std::vector<KeyDescription> keys = list_keys(schema);
  std::string out =
      "# Keys of the case file\n\nKeys without a default are optional unless marked *required*. Text in quantities may "
      "carry a unit, as in `2.5 in`. Lists are shown without the numbers of their items.\n";
  std::string section;
  for (const KeyDescription& key : keys) {
    const std::string root = key.path.substr(0, key.path.find('.'));
    if (root == key.path) {
      section = root;
      out += "\n## `" + root + "`\n\n" + in_cell(paragraph(key)) + "\n";
      for (const std::string& example : key.examples) out += "\nExample: `" + root + ": " + example + "`\n";
      continue;
    }
    if (!section.empty()) out += "\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
    section.clear();
    std::string meaning = key.meaning;
    if (!key.typical.empty()) meaning += ". *Typical:* " + key.typical;
    for (const std::string& example : key.examples) meaning += ". *Example:* `" + example + "`";
    for (const auto& [word, what] : key.words) meaning += "<br>`" + word + "`: " + what;
    out += "| `" + key.path.substr(root.size() + 1) + "`" + (key.of.empty() ? "" : " (`" + key.of + "`)") + " | " +
           (key.same_as.empty() ? in_cell(key.value) : "as `" + key.same_as + "`") + " | " +
           (key.required           ? "*required*"
            : key.standard.empty() ? ""
                                   : "`" + key.standard + "`") +
           " | " + in_cell(meaning) + " |\n";
  }
  return out;
}

}  // namespace quicksand
