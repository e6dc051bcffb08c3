#pragma once
/// \file
/// A small valid case that tests spoil in one way or another.
#include <algorithm>
#include <string>
#include <vector>

#include "app/case_config.hpp"
#include "core/errors.hpp"

namespace quicksand {

/// One line per key, so that line numbers in messages can be checked.
inline const std::string valid_case = R"(title: A test
units: none
grid:
  dimension: 2
  geometry: axisymmetric
  x: {from: 0, to: 0.5, cells: 16}
  z: {from: 0, to: 1.5, cells: 48}
boundaries:
  x_min: axis
  x_max: no_slip
  z_min: no_slip
  z_max: {open: 1.0}
gravity: 1.0
ambient_pressure: 1.0
species:
  - name: sand
    density: 2.0
    rheology: {law: papanastasiou, viscosity: 0.1, yield_stress: 0.3, regularization: 200}
  - name: water
    density: 1.0
    rheology: {law: newtonian, viscosity: 0.01}
initial:
  - fill: sand
    shape: {cylinder: {center: [0, 0, 0], radius: 0.25, height: 1.0}}
time: {end: 4.0, step: 5.0e-4}
output:
  directory: results/test
  fields: {every: 0.1}
)";

/// The case with the first occurrence of `from` replaced.
inline std::string with(const std::string& from, const std::string& to, std::string text = valid_case) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("test: no '" + from + "' in the case");
  return text.replace(at, from.size(), to);
}

/// Message of the InputError that reading the case throws; empty if it throws none.
inline std::string error_of(const std::string& text, const std::vector<std::string>& settings = {}) {
  try {
    parse_case(text, "case.yaml", settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

inline std::size_t count_lines(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace quicksand
