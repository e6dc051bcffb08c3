#include "core/config_reader.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Builds the tree from the parser's events, which carry the place of every key and value.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string source) : source_(std::move(source)) {}

  ConfigDocument take() { return std::move(document_); }
  bool empty() const { return !finished_; }
  /// Where the last scalar begins if it is quoted.
  const std::optional<YAML::Mark>& last_quote() const { return last_quote_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(node(ConfigNode::Kind::none, mark)); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw InputError(to_string(place(mark)) + ": aliases (*name) are not supported; repeat the value");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& value) override {
    ConfigNode scalar = node(ConfigNode::Kind::scalar, mark);
    scalar.text = value;
    scalar.quoted = tag != "?";
    last_quote_ = scalar.quoted ? std::optional(mark) : std::nullopt;
    add(std::move(scalar));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(node(ConfigNode::Kind::list, mark));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(node(ConfigNode::Kind::map, mark));
  }
  void OnMapEnd() override { close(); }

 private:
  /// A list or mapping whose end has not come yet, and in a mapping the key that waits for its value.
  struct Open {
    ConfigNode node;
    std::optional<ConfigNode> key;
  };

  Place place(const YAML::Mark& mark) const { return {source_, mark.line + 1, mark.column + 1}; }

  ConfigNode node(ConfigNode::Kind kind, const YAML::Mark& mark) const {
    ConfigNode result;
    result.kind = kind;
    result.place = place(mark);
    result.key_place = result.place;
    return result;
  }

  bool expects_key() const {
    return !open_.empty() && open_.back().node.kind == ConfigNode::Kind::map && !open_.back().key;
  }

  void add(ConfigNode value) {
    if (expects_key()) {
      open_.back().key = std::move(value);
    } else {
      open(std::move(value));
      close();
    }
  }

  void open(ConfigNode value) {
    if (expects_key())
      throw InputError(to_string(value.place) +
                       ": not valid YAML: a key must be a single word (is a bracket left open?)");
    if (!open_.empty()) {
      Open& parent = open_.back();
      if (parent.node.kind == ConfigNode::Kind::map) {
        value.key = parent.key->text;
        value.key_place = parent.key->place;
        value.path = child_path(parent.node.path, value.key);
        // The parser places a missing value where the next thing begins.
        if (value.kind == ConfigNode::Kind::none) value.place = value.key_place;
      } else {
        value.path = child_path(parent.node.path, parent.node.children.size());
      }
    }
    open_.push_back({std::move(value), std::nullopt});
  }

  void close() {
    ConfigNode value = std::move(open_.back().node);
    open_.pop_back();
    if (open_.empty()) {
      document_.root = std::move(value);
      finished_ = true;
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == ConfigNode::Kind::map) {
      parent.key.reset();
      if (const ConfigNode* first = parent.node.find(value.key)) {
        document_.problems.push_back({value.key_place, value.path,
                                      "given twice; first in line " + std::to_string(first->key_place.line), false});
        return;
      }
    }
    parent.node.children.push_back(std::move(value));
  }

  std::string source_;
  std::vector<Open> open_;
  ConfigDocument document_;
  std::optional<YAML::Mark> last_quote_;
  bool finished_ = false;
};

/// Names the nodes below and gives them one place, for values that come from the command line.
void relocate(ConfigNode& node, const std::string& path, const Place& place) {
  node.path = path;
  node.place = node.key_place = place;
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    ConfigNode& child = node.children[i];
    const bool map = node.kind == ConfigNode::Kind::map;
    relocate(child, map ? child_path(path, child.key) : child_path(path, i), place);
  }
}

/// Splits `a.0.b` or `a[0].b` into its parts.
std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char ch : path) {
    if (ch == '.' || ch == '[') {
      parts.emplace_back();
    } else if (ch != ']') {
      parts.back() += ch;
    }
  }
  return parts;
}

/// Position of a list element named by its index, if there is one.
std::optional<std::size_t> find_element(const ConfigNode& list, const std::string& index) {
  for (std::size_t i = 0; i < list.children.size(); ++i) {
    if (std::to_string(i) == index) return i;
  }
  return std::nullopt;
}

/// Reason why a file can't be read as text.
std::string why_unreadable(const std::string& file) {
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (!std::filesystem::exists(status)) return "no such file";
  if (std::filesystem::is_directory(status)) return "is a folder, not a file";
  return std::strerror(errno);
}

/// Whether a text in quotes that begins at a place has no end. The parser takes all that follows for part of it.
bool is_left_open(const std::string& text, std::size_t begin) {
  if (begin >= text.size() || (text[begin] != '"' && text[begin] != '\'')) return false;
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (text[i] == '\\' && text[begin] == '"') {
      ++i;
    } else if (text[i] == text[begin]) {
      // Two single quotes stand for one.
      if (text[begin] == '"' || i + 1 >= text.size() || text[i + 1] != '\'') return false;
      ++i;
    }
  }
  return true;
}

}  // namespace

ConfigDocument parse_yaml(const std::string& text, const std::string& source) {
  TreeBuilder builder(source);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    if (const auto& mark = builder.last_quote(); mark && is_left_open(text, static_cast<std::size_t>(mark->pos))) {
      throw InputError(to_string(Place{source, mark->line + 1, mark->column + 1}) +
                       ": not valid YAML: the quote that begins here is never closed");
    }
    TreeBuilder more(source);
    if (parser.HandleNextDocument(more) && !more.empty()) {
      throw InputError(to_string(more.take().root.place) + ": holds a second YAML document");
    }
  } catch (const YAML::Exception& error) {
    const Place place{source, error.mark.line + 1, error.mark.column + 1};
    throw InputError(to_string(error.mark.is_null() ? Place{source, 0, 0} : place) + ": not valid YAML: " + error.msg);
  }
  if (builder.empty()) throw InputError(source + ": is empty");
  return builder.take();
}

ConfigDocument read_yaml_file(const std::string& file) {
  std::error_code code;
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, code)) {
    throw InputError(file + ": can't be read: " + why_unreadable(file));
  }
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw InputError(file + ": can't be read: " + why_unreadable(file));
  if (text.find('\0') != std::string::npos) throw InputError(file + ": is not a text file");
  return parse_yaml(text, file);
}

void apply_setting(ConfigDocument& document, const std::string& setting) {
  const Place place{"--set " + setting, 0, 0};
  const auto fail = [&](const std::string& path, const std::string& message) {
    document.problems.push_back({place, path, message});
  };
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) return fail({}, "must have the form KEY.PATH=VALUE");
  const std::string path = setting.substr(0, equals);
  const std::string value = setting.substr(equals + 1);

  ConfigNode* node = &document.root;
  for (const std::string& part : split_path(path)) {
    if (node->kind == ConfigNode::Kind::list) {
      const std::size_t count = node->children.size();
      const std::optional<std::size_t> element = find_element(*node, part);
      if (!element) {
        return fail(node->path, "is a list of " + std::to_string(count) + "; name its elements by 0 to " +
                                    std::to_string(count == 0 ? 0 : count - 1) + ", not '" + part + "'");
      }
      node = &node->children[*element];
    } else if (node->kind == ConfigNode::Kind::scalar) {
      return fail(node->path, "is a single value and has no '" + part + "'");
    } else {
      if (part.empty()) return fail(node->path, "the path has an empty part");
      ConfigNode* child = node->find(part);
      if (child == nullptr) {
        child = &node->add(part, {});
        child->path = child_path(node->path, part);
        child->place = child->key_place = place;
      }
      node = child;
    }
  }
  try {
    ConfigNode fresh;
    if (!value.empty()) fresh = parse_yaml(value, place.source).root;
    fresh.key = node->key;
    relocate(fresh, node->path, place);
    *node = std::move(fresh);
  } catch (const InputError&) {
    fail(node->path, "the value is not valid YAML");
  }
}

std::string list_problems(std::vector<ConfigProblem> problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const ConfigProblem& a, const ConfigProblem& b) {
    const auto order = [](const Place& p) { return std::pair(p.line == 0, std::pair(p.line, p.column)); };
    return order(a.place) < order(b.place);
  });
  std::string text;
  for (const ConfigProblem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += to_string(problem.place) + ": " + (problem.path.empty() ? "" : problem.path + ": ") + problem.message;
  }
  return text;
}

}  // namespace quicksand
