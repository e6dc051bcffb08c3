#include "core/config_codec.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>

#include "core/config_schema.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

using Kind = ConfigNode::Kind;

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// Smallest number of inserted, deleted, replaced or swapped neighbouring letters between two words, large or small.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] =
          std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same_letter(a[i - 1], b[j - 1]) ? 0u : 1u)});
      const bool swapped = i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) && same_letter(a[i - 2], b[j - 1]);
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::string allowed_range(const Range& range) {
  const bool low = range.low > any_number.low;
  const bool high = range.high < any_number.high;
  std::string text;
  if (low) text += (range.low_excluded ? "greater than " : "at least ") + shortest(range.low);
  if (high) text += (low ? " and at most " : "at most ") + shortest(range.high);
  return text;
}

/// Whether a path is another one or leads to something within it.
bool is_at_or_below(const std::string& path, const std::string& other) {
  if (!path.starts_with(other)) return false;
  return other.empty() || path.size() == other.size() || path[other.size()] == '.' || path[other.size()] == '[';
}

/// Finds the deepest node on a path such as `species[1].name`.
const ConfigNode& follow(const ConfigNode& node, const std::string& path) {
  for (const ConfigNode& child : node.children) {
    if (is_at_or_below(path, child.path)) return follow(child, path);
  }
  return node;
}

}  // namespace

const ConfigNode& Reading::nearest(const std::string& path) const { return follow(root_, path); }

void Reading::problem(const ConfigNode& where, std::string message) {
  problems_.push_back({where.place, where.path, std::move(message)});
}

void Reading::problem(const std::string& path, std::string message) {
  problems_.push_back({nearest(path).place, path, std::move(message)});
}

void Reading::key_problem(const ConfigNode& where, std::string message) {
  problems_.push_back({where.key_place, where.path, std::move(message), false});
}

bool Reading::clean(const std::string& path) const {
  return std::none_of(problems_.begin(), problems_.end(), [&](const ConfigProblem& problem) {
    return problem.spoils_value && (is_at_or_below(problem.path, path) || is_at_or_below(path, problem.path));
  });
}

std::string in_quotes(const std::string& text) { return "'" + text + "'"; }

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 64;
  if (word.size() > longest) return "";
  std::size_t least = 1 + word.size() / 3;
  std::string nearest;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance > least || (distance == least && !nearest.empty()) || distance >= candidate.size()) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest.empty() ? "" : "; did you mean " + in_quotes(nearest) + "?";
}

Codec<double> quantity(const Dimension& dimension, const Range& range) {
  Codec<double> codec;
  codec.read = [dimension, range](Reading& reading, const ConfigNode& node, double& out) {
    if (node.kind != Kind::scalar) {
      reading.problem(node, "must be a number, not " + detail::kind_name(node));
      return;
    }
    try {
      const double value = parse_quantity(node.text, dimension, reading.units);
      if (!range.contains(value)) throw InputError("must be " + allowed_range(range) + ", not " + node.text);
      out = value;
    } catch (const InputError& error) {
      reading.problem(node, error.what());
    }
  };
  codec.write = [](const double& value) { return make_number(value); };
  codec.schema = detail::quantity_schema(dimension, range);
  return codec;
}

Codec<int> whole_number(int least, int most) {
  Codec<int> codec;
  codec.read = [least, most](Reading& reading, const ConfigNode& node, int& out) {
    const std::string wanted = most == std::numeric_limits<int>::max()
                                   ? "at least " + std::to_string(least)
                                   : "from " + std::to_string(least) + " to " + std::to_string(most);
    int value = 0;
    const char* end = node.text.data() + node.text.size();
    const auto result = std::from_chars(node.text.data(), end, value);
    if (node.kind != Kind::scalar) {
      reading.problem(node, "must be a whole number, not " + detail::kind_name(node));
    } else if (node.quoted || result.ec == std::errc::invalid_argument || result.ptr != end) {
      reading.problem(node, "must be a whole number " + wanted + ", not " + in_quotes(node.text));
    } else if (result.ec != std::errc{} || value < least || value > most) {
      reading.problem(node, "must be " + wanted + ", not " + node.text);
    } else {
      out = value;
    }
  };
  codec.write = [](const int& value) { return make_integer(value); };
  codec.schema = detail::typed_schema("integer");
  codec.schema.add("minimum", make_integer(least));
  if (most < std::numeric_limits<int>::max()) codec.schema.add("maximum", make_integer(most));
  return codec;
}

Codec<bool> flag() {
  Codec<bool> codec;
  codec.read = [](Reading& reading, const ConfigNode& node, bool& out) {
    const bool yes = node.text == "true";
    if (node.kind != Kind::scalar || node.quoted || (!yes && node.text != "false")) {
      const std::string found = node.kind == Kind::scalar ? in_quotes(node.text) : detail::kind_name(node);
      reading.problem(node, "must be true or false, not " + found);
    } else {
      out = yes;
    }
  };
  codec.write = [](const bool& value) { return make_flag(value); };
  codec.schema = detail::typed_schema("boolean");
  return codec;
}

Codec<std::string> text() {
  Codec<std::string> codec;
  codec.read = [](Reading& reading, const ConfigNode& node, std::string& out) {
    if (node.kind != Kind::scalar) {
      reading.problem(node, "must be text, not " + detail::kind_name(node));
    } else if (node.text.empty()) {
      reading.problem(node, "must not be empty");
    } else {
      out = node.text;
    }
  };
  codec.write = [](const std::string& value) { return make_text(value); };
  codec.schema = detail::typed_schema("string");
  codec.schema.add("minLength", make_integer(1));
  return codec;
}

Codec<std::string> identifier() {
  Codec<std::string> codec = text();
  codec.read = [read = codec.read](Reading& reading, const ConfigNode& node, std::string& out) {
    std::string name;
    read(reading, node, name);
    if (name.empty()) return;
    const bool fits = std::all_of(name.begin(), name.end(),
                                  [](char ch) { return std::isalnum(static_cast<unsigned char>(ch)) || ch == '_'; });
    if (!fits || std::isdigit(static_cast<unsigned char>(name.front()))) {
      reading.problem(node, "must consist of letters, digits and _ and not begin with a digit, not " + in_quotes(name));
    } else {
      out = name;
    }
  };
  codec.schema.add("pattern", make_text("^[A-Za-z_][A-Za-z0-9_]*$"));
  codec.schema.add(schema_value, make_text("name of letters, digits and _"));
  return codec;
}

Codec<Vec<3>> vector_of(const Dimension& dimension) {
  Codec<Vec<3>> codec;
  const Codec<double> component = quantity(dimension);
  codec.read = [component](Reading& reading, const ConfigNode& node, Vec<3>& out) {
    const int length = reading.vector_length;
    if (node.kind != Kind::list || node.children.size() < 2 || node.children.size() > 3 ||
        (length == 3 && node.children.size() != 3)) {
      const std::string found =
          node.kind == Kind::list ? std::to_string(node.children.size()) + " numbers" : detail::kind_name(node);
      reading.problem(node,
                      std::string("must be a vector [x, y, z]") + (length == 3 ? "" : " or [x, z]") + ", not " + found);
      return;
    }
    Vec<3> value;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      const int axis = i + 1 == node.children.size() ? 2 : static_cast<int>(i);
      component.read(reading, node.children[i], value[axis]);
    }
    if (length == 2 && value[1] != 0) reading.problem(node, "the y component must be 0 in two dimensions");
    out = value;
  };
  codec.write = [](const Vec<3>& v) { return make_list({make_number(v[0]), make_number(v[1]), make_number(v[2])}); };
  codec.schema = detail::list_schema(component.schema, 2);
  codec.schema.add("maxItems", make_integer(3));
  codec.schema.add(schema_value, make_text("vector [x, z] or [x, y, z], " + quantity_in_si(dimension)));
  return codec;
}

namespace detail {

std::string kind_name(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::none: return "nothing";
    case Kind::scalar: return in_quotes(node.text);
    case Kind::list: return "a list";
    case Kind::map: return "a mapping";
  }
  return {};
}

bool expect(Reading& reading, const ConfigNode& node, Kind kind) {
  if (node.kind == kind) return true;
  reading.problem(node, std::string("must be ") + (kind == Kind::map ? "a mapping of keys" : "a list") + ", not " +
                            kind_name(node));
  return false;
}

void unknown_key(Reading& reading, const ConfigNode& entry, const std::vector<std::string>& allowed,
                 const std::string& of) {
  const std::string where = of.empty() ? "" : " for " + in_quotes(of);
  const std::string list = allowed.empty() ? "; none are allowed" : "; allowed keys are " + join(allowed);
  reading.key_problem(entry, "unknown key" + where + suggestion(entry.key, allowed) + list);
}

void missing_key(Reading& reading, const ConfigNode& map, const std::string& name, const std::string& meaning) {
  reading.problem(child_path(map.path, name), "is required but missing: " + meaning);
}

void wrong_word(Reading& reading, const ConfigNode& node, const std::vector<std::string>& allowed) {
  const std::string near = node.kind == Kind::scalar ? suggestion(node.text, allowed) : "";
  reading.problem(node, "must be one of " + join(allowed) + ", not " + kind_name(node) + near);
}

}  // namespace detail

}  // namespace quicksand
