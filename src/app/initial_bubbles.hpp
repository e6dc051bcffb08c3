#pragma once
/// \file
/// The bubbles that a case begins with: those given as such, and those of its charges.
#include <vector>

#include "app/case_config.hpp"
#include "physics/charge.hpp"

namespace quicksand {

/// A charge where a case puts it.
struct PlacedCharge {
  double depth = 0;    ///< of its middle below the surface of the liquid above it
  double p_inf = 0;    ///< pressure around it
  double density = 0;  ///< of the liquid at that surface
  ExplosionBubble bubble;
};

/// The bubble of a charge under the pressure (60) of the liquid above it,
///     P_inf = P_A + rho g d,
/// d the depth below the surface at which the liquid right above the charge ends, rho the density of the species at
/// that surface and g gravity along -z: as the report does for a charge in sand under water, what lies above the charge
/// counts as the topmost liquid. Where the liquid reaches an open top with liquid outside, P_A is the pressure of that
/// side.
///
/// \pre the grid, species and fills of the case are in order
/// \throws InputError if the middle is not in liquid, or if explosion_bubble() throws
PlacedCharge place_charge(const CaseConfig& config, const InitialCharge& charge);

/// `bubbles`, followed by the first bubble of each charge.
/// \throws as place_charge()
std::vector<InitialBubble> initial_bubbles(const CaseConfig& config);

}  // namespace quicksand
