#pragma once
/// \file
/// One description of an object's memory for both ways, to a file and from it, so that the two can't drift apart.
///
///     void exchange(Archive& archive) {
///       carry(archive, "flow/time", time_);
///       carry(archive, "flow/pressure", pressure_);
///     }
#include <algorithm>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "core/field.hpp"

namespace quicksand {

/// Named values on their way to a file or from one. Names are paths, each used once.
class Archive {
 public:
  virtual ~Archive() = default;

  /// Whether values come from the file; else they go to it.
  virtual bool loading() const = 0;
  /// Stores the values, or replaces them by those of that name. \throws FileError
  virtual void exchange(const std::string& name, std::vector<double>& values) = 0;
  virtual void exchange(const std::string& name, std::vector<std::int64_t>& values) = 0;
  virtual void exchange(const std::string& name, std::string& text) = 0;
  /// Refuses values that were read. \throws FileError with the name and the reason
  [[noreturn]] virtual void refuse(const std::string& name, const std::string& why) const = 0;
};

/// The type that numbers of type T are stored as.
template <class T>
using Stored = std::conditional_t<std::is_integral_v<T>, std::int64_t, double>;

/// A single number or flag.
template <class T>
requires std::is_arithmetic_v<T>
void carry(Archive& archive, const std::string& name, T& value) {
  std::vector<Stored<T>> stored{static_cast<Stored<T>>(value)};
  archive.exchange(name, stored);
  if (stored.size() != 1) archive.refuse(name, "not a single number");
  value = static_cast<T>(stored.front());
}

/// One member of all items of a list; the first member of a list that is read gives it its length.
template <class S, class T>
void carry(Archive& archive, const std::string& name, std::vector<S>& items, T S::*member) {
  std::vector<Stored<T>> column;
  for (const S& item : items) column.push_back(static_cast<Stored<T>>(item.*member));
  archive.exchange(name, column);
  if (archive.loading() && items.empty()) items.resize(column.size());
  if (column.size() != items.size()) archive.refuse(name, "another length than its list");
  for (std::size_t i = 0; i < items.size(); ++i) items[i].*member = static_cast<T>(column[i]);
}

/// A list or array of numbers whose length is known.
template <class Numbers>
requires std::is_arithmetic_v<typename Numbers::value_type>
void carry_numbers(Archive& archive, const std::string& name, Numbers& numbers) {
  using T = typename Numbers::value_type;
  std::vector<Stored<T>> stored(numbers.begin(), numbers.end());
  archive.exchange(name, stored);
  if (stored.size() != numbers.size()) {
    archive.refuse(name, std::to_string(stored.size()) + " values, not " + std::to_string(numbers.size()));
  }
  std::transform(stored.begin(), stored.end(), numbers.begin(), [](Stored<T> value) { return static_cast<T>(value); });
}

/// A field with its ghost layers: of numbers, or of structs of doubles.
template <class At, class T>
void carry(Archive& archive, const std::string& name, Field<At, T>& field) {
  if constexpr (std::is_arithmetic_v<T>) {
    carry_numbers(archive, name, field.values());
  } else {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
    auto& values = field.values();
    std::vector<double> flat(values.size() * (sizeof(T) / sizeof(double)));
    if (!flat.empty()) std::memcpy(flat.data(), values.data(), values.size() * sizeof(T));
    carry_numbers(archive, name, flat);
    if (!flat.empty()) std::memcpy(static_cast<void*>(values.data()), flat.data(), values.size() * sizeof(T));
  }
}

/// A vector field, component by component.
template <int Dim, class At>
void carry(Archive& archive, const std::string& name, Components<Dim, At>& field) {
  for (int d = 0; d < Dim; ++d) carry(archive, name + "/" + std::to_string(d), field[d]);
}

/// A list of fields whose length is known.
template <class At, class T>
void carry(Archive& archive, const std::string& name, std::vector<Field<At, T>>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) carry(archive, name + "/" + std::to_string(i), fields[i]);
}

}  // namespace quicksand
