#pragma once
/// \file
/// Physical dimensions and units of quantities given as text, e.g. `2.5 in` or `1000 kg/m^3`.
#include <string>
#include <string_view>

namespace quicksand {

/// Whether quantities are SI and may carry a unit, or are plain numbers (nondimensional).
enum class UnitSystem { si, none };

/// Exponents of mass, length and time.
struct Dimension {
  int mass = 0;
  int length = 0;
  int time = 0;
  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

namespace dimension {
inline constexpr Dimension none{};
inline constexpr Dimension length{0, 1, 0};
inline constexpr Dimension wavenumber{0, -1, 0};
inline constexpr Dimension time{0, 0, 1};
inline constexpr Dimension mass{1, 0, 0};
inline constexpr Dimension velocity{0, 1, -1};
inline constexpr Dimension acceleration{0, 1, -2};
inline constexpr Dimension density{1, -3, 0};
inline constexpr Dimension pressure{1, -1, -2};
inline constexpr Dimension viscosity{1, -1, -1};
}  // namespace dimension

/// Sizes in SI of the units in which constants of explosives are listed.
namespace traditional {
inline constexpr double foot = 0.3048;
inline constexpr double pound = 0.45359237;
inline constexpr double foot_of_water = 1000 * 9.80665 * foot;  ///< conventional water and standard gravity
}  // namespace traditional

/// Name of a dimension with an example unit, e.g. `a pressure (such as Pa)`.
std::string to_string(const Dimension& dimension);

/// Name of a dimension with its unit in SI, e.g. `pressure or stress in Pa`; `number` without one.
std::string quantity_in_si(const Dimension& dimension);

/// A unit: its dimension and its size in SI.
struct Unit {
  Dimension dimension;
  double factor = 1;
};

/// Reads a product of units with integer powers, such as `kg/m^3`, `Pa s`, `m*s^-2`, `1/in`; see find_unit().
/// \throws InputError naming the symbol that is not known
Unit parse_unit(std::string_view text);

/// Reads a number with an optional unit and returns its SI value.
/// \throws InputError if the text is no number, is not finite, or has a unit of another dimension (or any unit where
///         `system` is none)
double parse_quantity(std::string_view text, const Dimension& expected, UnitSystem system);

}  // namespace quicksand
