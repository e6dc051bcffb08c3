#include "core/text_output.hpp"

#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <iterator>

#include "core/atomic_file.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

template <class... Case>
struct Overloaded : Case... {
  using Case::operator()...;
};
template <class... Case>
Overloaded(Case...) -> Overloaded<Case...>;

std::string header(const std::vector<std::string>& columns) {
  std::string line;
  for (const std::string& column : columns) line += (line.empty() ? "" : ",") + column;
  return line;
}

std::string line_of(std::span<const double> values) {
  std::string line;
  for (const double value : values) line += (line.empty() ? "" : ",") + number_text(value);
  return line + '\n';
}

/// The lines of a table up to `last_step`, header included.
std::string kept_lines(const std::filesystem::path& path, const std::string& expected_header, std::int64_t last_step) {
  std::ifstream in(path);
  if (!in) throw FileError(path.string() + ": cannot open for reading");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::string kept;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    if (begin == 0) {
      if (line != expected_header) {
        throw FileError(path.string() + ": cannot continue a table with other columns:\n  " + line + "\nnow\n  " +
                        expected_header);
      }
    } else {
      double step = 0;
      const auto read = std::from_chars(line.data(), line.data() + line.size(), step);
      if (read.ec != std::errc() || step > static_cast<double>(last_step)) break;
    }
    kept += line + "\n";
  }
  return kept.empty() ? expected_header + "\n" : kept;
}

}  // namespace

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return std::string(buffer.data(), end);
}

std::string json_quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"': out += "\\\""; break;
      case '\\': out += "\\\\"; break;
      case '\n': out += "\\n"; break;
      case '\r': out += "\\r"; break;
      case '\t': out += "\\t"; break;
      default:
        if (static_cast<unsigned char>(c) < 0x20) {
          constexpr std::string_view digits = "0123456789abcdef";
          const auto code = static_cast<unsigned char>(c);
          out += "\\u00";
          out += digits[code >> 4U];
          out += digits[code & 15U];
        } else {
          out += c;
        }
    }
  }
  return out + "\"";
}

Json Json::object() {
  Json json;
  json.value_ = Object{};
  return json;
}

Json Json::array() {
  Json json;
  json.value_ = Array{};
  return json;
}

Json& Json::operator[](std::string_view key) {
  if (std::holds_alternative<std::monostate>(value_)) value_ = Object{};
  assert(std::holds_alternative<Object>(value_));
  auto& members = std::get<Object>(value_);
  for (auto& [name, member] : members) {
    if (name == key) return member;
  }
  return members.emplace_back(std::string(key), Json()).second;
}

void Json::append(Json value) {
  if (std::holds_alternative<std::monostate>(value_)) value_ = Array{};
  assert(std::holds_alternative<Array>(value_));
  std::get<Array>(value_).push_back(std::move(value));
}

std::string Json::text() const {
  std::string out;
  print(out, 0);
  return out + "\n";
}

void Json::print(std::string& out, int level) const {
  const auto new_line = [&out](int indentation) {
    out += "\n" + std::string(2 * static_cast<std::size_t>(indentation), ' ');
  };
  std::visit(Overloaded{
                 [&](std::monostate) { out += "null"; },
                 [&](bool value) { out += value ? "true" : "false"; },
                 [&](std::int64_t value) { out += std::to_string(value); },
                 [&](double value) { out += std::isfinite(value) ? number_text(value) : "null"; },
                 [&](const std::string& value) { out += json_quoted(value); },
                 [&](const Array& values) {
                   out += "[";
                   for (std::size_t n = 0; n < values.size(); ++n) {
                     if (n > 0) out += ", ";
                     values[n].print(out, level + 1);
                   }
                   out += "]";
                 },
                 [&](const Object& members) {
                   out += "{";
                   for (std::size_t n = 0; n < members.size(); ++n) {
                     if (n > 0) out += ",";
                     new_line(level + 1);
                     out += json_quoted(members[n].first) + ": ";
                     members[n].second.print(out, level + 1);
                   }
                   if (!members.empty()) new_line(level);
                   out += "}";
                 },
             },
             value_);
}

CsvWriter::CsvWriter(const std::filesystem::path& path, std::vector<std::string> columns,
                     std::optional<std::int64_t> last_step)
    : path_(path), columns_(std::move(columns)) {
  const std::string names = header(columns_);
  const bool goes_on = last_step && std::filesystem::exists(path_);
  write_text_file(path_, goes_on ? kept_lines(path_, names, *last_step) : names + "\n");
  out_.open(path_, std::ios::app);
  if (!out_) throw FileError(path_.string() + ": cannot open for writing");
}

void CsvWriter::append(std::span<const double> values) {
  assert(values.size() == columns_.size());
  write(line_of(values));
}

void CsvWriter::append_lines(std::span<const std::vector<double>> lines) {
  std::string text;
  for (const std::vector<double>& values : lines) {
    assert(values.size() == columns_.size());
    text += line_of(values);
  }
  write(text);
}

void CsvWriter::append_text(std::span<const std::string> values) {
  assert(values.size() == columns_.size());
  std::string line;
  for (const std::string& value : values) {
    if (!line.empty()) line += ',';
    line += value;
  }
  write(line + '\n');
}

void CsvWriter::write(const std::string& text) {
  out_ << text << std::flush;
  if (!out_) throw FileError(path_.string() + ": cannot write");
}

void CsvWriter::sync() const { flush_to_disk(path_); }

}  // namespace quicksand
