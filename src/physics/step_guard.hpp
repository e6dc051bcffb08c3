#pragma once
/// \file
/// What a step must keep to be accepted: finite values, the volume of every species, and the energy, which
/// redistribution and projection can't raise. A step that does not is the work of a solver that went wrong, or of a
/// defect.
#include <vector>

#include "physics/solver_settings.hpp"
#include "physics/species.hpp"
#include "physics/state.hpp"

namespace quicksand {

/// Volumes of all species plus what has escaped, and rises of energy in one step.
struct StepBalance {
  std::vector<double> volume_before;
  std::vector<double> volume_after;
  double liquid = 0;  ///< volume in the domain after the step
  double redistribution_rise = 0;
  double projection_rise = 0;  ///< beyond the work of gas and inflow
  double energy_scale = 0;     ///< what rises are compared with
};

/// \throws NumericalError with the bound, the value and the species or phase
void check_balance(const StepBalance& balance, const std::vector<Species>& species, const GuardSettings& guard);

/// \throws NumericalError where a fraction, velocity or pressure is not finite
template <int Dim>
void require_finite(const Grid<Dim>& grid, const State<Dim>& state);

/// Volume of every species in the domain, plus what has escaped; per radian in axisymmetric flows.
template <int Dim>
std::vector<double> volumes(const Grid<Dim>& grid, const Fractions& phi, const std::vector<double>& escaped);

/// Energy at stake in a state: kinetic, internal energy of the bubbles, and what the whole mass gains falling through
/// the domain, sum of mass |g_d| length_d. Per radian in axisymmetric flows.
template <int Dim>
double energy_at_stake(const Grid<Dim>& grid, const CellField& rho, const State<Dim>& state, const Vec<Dim>& gravity);

/// Kinetic energy of a motion that moves nothing by more than 1e-10 of the smallest cell in a step: round-off.
template <int Dim>
double negligible_energy(const Grid<Dim>& grid, const CellField& rho, double dt);

}  // namespace quicksand
