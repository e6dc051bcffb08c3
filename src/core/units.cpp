#include "core/units.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/errors.hpp"
#include "core/unit_database.hpp"

namespace quicksand {

namespace {

struct Name {
  Dimension dimension;
  const char* article;
  const char* text;
  const char* unit;
};

constexpr Name names[] = {
    {dimension::length, "a ", "length", "m"},
    {dimension::wavenumber, "a ", "wavenumber", "1/m"},
    {dimension::time, "a ", "time", "s"},
    {dimension::mass, "a ", "mass", "kg"},
    {dimension::velocity, "a ", "velocity", "m/s"},
    {dimension::acceleration, "an ", "acceleration", "m/s^2"},
    {dimension::density, "a ", "density", "kg/m^3"},
    {dimension::pressure, "a ", "pressure or stress", "Pa"},
    {dimension::viscosity, "a ", "viscosity", "Pa s"},
};

const Name* find_name(const Dimension& dimension) {
  for (const Name& name : names) {
    if (name.dimension == dimension) return &name;
  }
  return nullptr;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

bool is_part_of_word(char ch) { return std::isalnum(static_cast<unsigned char>(ch)) || ch == '_'; }

/// Takes `^n` from the front of the text; 1 if there is none.
int take_exponent(std::string_view& text) {
  if (text.empty() || text.front() != '^') return 1;
  int exponent = 0;
  const auto result = std::from_chars(text.data() + 1, text.data() + text.size(), exponent);
  if (result.ec != std::errc{} || std::abs(exponent) > 9)
    throw InputError("'^' must be followed by a small whole number");
  text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
  return exponent;
}

}  // namespace

std::string to_string(const Dimension& dimension) {
  if (dimension == dimension::none) return "a plain number";
  if (const Name* name = find_name(dimension)) {
    return std::string(name->article) + name->text + " (such as " + name->unit + ")";
  }
  return "mass^" + std::to_string(dimension.mass) + " length^" + std::to_string(dimension.length) + " time^" +
         std::to_string(dimension.time);
}

std::string quantity_in_si(const Dimension& dimension) {
  if (dimension == dimension::none) return "number";
  const Name* name = find_name(dimension);
  return name != nullptr ? std::string(name->text) + " in " + name->unit : to_string(dimension);
}

Unit parse_unit(std::string_view text) {
  Unit unit;
  text = trimmed(text);
  int sign = 1;
  bool needs_symbol = true;
  while (!text.empty()) {
    const char ch = text.front();
    if (std::isspace(static_cast<unsigned char>(ch))) {
      text.remove_prefix(1);
    } else if (ch == '*' || ch == '/') {
      if (needs_symbol) throw InputError("'" + std::string(1, ch) + "' must stand between two units");
      sign = ch == '/' ? -1 : 1;
      needs_symbol = true;
      text.remove_prefix(1);
    } else {
      std::size_t length = 0;
      while (length < text.size() && is_part_of_word(text[length])) ++length;
      if (length == 0) throw InputError("unit has an unexpected '" + std::string(1, ch) + "'");
      const std::string name(text.substr(0, length));
      text.remove_prefix(length);
      if (name != "1" && std::isdigit(static_cast<unsigned char>(ch))) throw InputError("unknown unit '" + name + "'");
      const Unit symbol = name == "1" ? Unit{} : find_unit(name);
      const int power = sign * take_exponent(text);
      unit.dimension.mass += power * symbol.dimension.mass;
      unit.dimension.length += power * symbol.dimension.length;
      unit.dimension.time += power * symbol.dimension.time;
      unit.factor *= std::pow(symbol.factor, power);
      sign = 1;
      needs_symbol = false;
    }
  }
  if (needs_symbol) throw InputError("unit is incomplete");
  return unit;
}

double parse_quantity(std::string_view text, const Dimension& expected, UnitSystem system) {
  const std::string shown = "'" + std::string(text) + "'";
  const std::string wanted = expected == dimension::none || system == UnitSystem::none
                                 ? "a plain number"
                                 : to_string(expected) + " or a number in SI";
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double number = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  if (result.ec == std::errc::invalid_argument) {
    const bool special = text == ".inf" || text == "-.inf" || text == ".nan" || text == ".NaN" || text == ".Inf";
    throw InputError(special ? "must be finite, not " + shown : "must be " + wanted + ", not " + shown);
  }
  if (result.ec == std::errc::result_out_of_range || !std::isfinite(number)) {
    throw InputError("must be finite and within the range of doubles, not " + shown);
  }
  const std::string_view unit_text = trimmed(text.substr(static_cast<std::size_t>(result.ptr - text.data())));
  if (unit_text.empty()) return number;
  if (!std::isalpha(static_cast<unsigned char>(unit_text.front())) && unit_text.front() != '/' &&
      unit_text.front() != '1') {
    throw InputError("must be " + wanted + ", not " + shown);
  }
  if (system == UnitSystem::none) throw InputError("takes a plain number where units are none, not " + shown);
  // `3 /m` means 3 per metre.
  const Unit unit = parse_unit(unit_text.front() == '/' ? "1" + std::string(unit_text) : std::string(unit_text));
  if (!(unit.dimension == expected)) {
    throw InputError("must be " + wanted + ", but the unit '" + std::string(unit_text) + "' is " +
                     to_string(unit.dimension));
  }
  const double value = number * unit.factor;
  if (!std::isfinite(value)) throw InputError("must be finite, not " + shown);
  return value;
}

}  // namespace quicksand
