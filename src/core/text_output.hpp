#pragma once
/// \file
/// Text that others read: JSON documents and CSV tables.
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace quicksand {

/// Shortest text that reads back as the same number; "nan", "inf" and "-inf" for the others.
std::string number_text(double value);

/// A JSON value that keeps its members in the order of insertion.
///
///     Json summary;
///     summary["status"] = "finished";
///     summary["phases"]["projection"]["seconds"] = 1.5;
///     write_text_file(path, summary.text());
class Json {
 public:
  Json() = default;  ///< null
  Json(bool value) : value_(value) {}
  Json(double value) : value_(value) {}  ///< null in the text where not finite: JSON knows no such numbers
  template <std::integral T>
  Json(T value) : value_(static_cast<std::int64_t>(value)) {}
  Json(std::string value) : value_(std::move(value)) {}
  Json(std::string_view value) : value_(std::string(value)) {}
  Json(const char* value) : value_(std::string(value)) {}
  template <class T>
  Json(const std::vector<T>& values) : value_(Array(values.begin(), values.end())) {}

  /// Member of an object, added as null where new; a null value becomes an object. \pre null or an object
  Json& operator[](std::string_view key);
  /// Appends to an array; a null value becomes an array. \pre null or an array
  void append(Json value);
  /// The document, two blanks per level, with a newline at the end.
  std::string text() const;

  /// An empty object or array, for members that must not be null.
  static Json object();
  static Json array();

 private:
  using Array = std::vector<Json>;
  using Object = std::vector<std::pair<std::string, Json>>;
  void print(std::string& out, int level) const;

  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Object> value_;
};

/// Text between quotes as JSON wants it.
std::string json_quoted(std::string_view text);

/// A table of numbers that grows line by line, such as `history.csv`. Every line reaches the file at once, so that the
/// table can be watched while the program runs.
class CsvWriter {
 public:
  /// Starts a new table, replacing a file of that name.
  /// \param last_step  continues a table whose first column counts steps: lines beyond this one and a torn last line
  ///                   are dropped. A file that does not exist is started.
  /// \throws FileError, also where the columns of the file are others
  CsvWriter(const std::filesystem::path& path, std::vector<std::string> columns,
            std::optional<std::int64_t> last_step = {});

  const std::vector<std::string>& columns() const { return columns_; }
  /// Adds one line. \pre one value per column \throws FileError
  void append(std::span<const double> values);
  /// Adds lines that belong together, in one go. \pre one value per column in each \throws FileError
  void append_lines(std::span<const std::vector<double>> lines);
  /// Adds one line of texts that need no quotes. \pre one per column \throws FileError
  void append_text(std::span<const std::string> values);
  /// Brings all lines so far safely to the disk. \throws FileError
  void sync() const;

 private:
  void write(const std::string& text);

  std::filesystem::path path_;
  std::vector<std::string> columns_;
  std::ofstream out_;
};

}  // namespace quicksand
