#pragma once
/// \file
/// What is measured of a flow after every step.
#include <numbers>
#include <vector>

#include "physics/flow.hpp"

namespace quicksand {

/// Integral and extreme values of the current state. Volumes and energies of axisymmetric flows are those of the whole
/// circle.
struct Diagnostics {
  std::vector<double> volume;  ///< of each species inside the domain
  double kinetic_energy = 0;
  double potential_energy = 0;  ///< -sum m g . x
  double max_speed = 0;         ///< where sum phi >= empty_fraction
  double max_speed_liquid = 0;  ///< where sum phi >= 0.9
  double height_axis = 0;       ///< first crossing of sum phi = 0.5 going up the axis column
  double height_max = 0;        ///< top of the highest cell with sum phi >= 0.5
  double radius_base = 0;       ///< where liquid ends along the lowest row of cells, going outwards
};

/// Volume over one radian to that of the whole circle: 2 pi in axisymmetric flows, else 1.
template <int Dim>
double full_circle(const Grid<Dim>& grid) {
  return grid.axisymmetric() ? 2 * std::numbers::pi : 1.0;
}

/// Measures the flow. The axis column is the one at x = x_min if that side is an axis or symmetry plane, else the
/// middle one (the same for y); the lowest row runs through it.
template <int Dim>
Diagnostics diagnose(const Flow<Dim>& flow);

/// Whole volume of one species, per radian in axisymmetric flows: the sum that conservation is judged by.
template <int Dim>
double species_volume(const Grid<Dim>& grid, const CellField& phi);

}  // namespace quicksand
