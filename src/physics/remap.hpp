#pragma once
/// \file
/// A flow moved from one grid to another.
#include "physics/flow.hpp"

namespace quicksand {

/// What a remap did.
struct RemapReport {
  double kinetic_energy_before = 0;
  double kinetic_energy = 0;  ///< after, never greater
  std::vector<GasEvent> gas;  ///< bubbles that became one, or opened, on the other grid
};

/// The flow on another grid of the same domain. Volumes of all species, momentum, and gas are conserved to round-off;
/// neither kinetic energy nor the largest speed rises.
///
/// Fractions are cut along the planes of the surfaces (SpeciesParts), velocities and last accelerations move with their
/// masses (MassMap), the pressure is interpolated. Bubbles keep their gas and take the pressure of their volume. Time,
/// step number and step size stay; stresses and multipliers that only speed up solves start anew.
/// \throws InputError where the domains differ
template <int Dim>
Flow<Dim> remap(const Flow<Dim>& flow, Domain<Dim> domain, RemapReport& report);

extern template Flow<2> remap(const Flow<2>&, Domain<2>, RemapReport&);
extern template Flow<3> remap(const Flow<3>&, Domain<3>, RemapReport&);

}  // namespace quicksand
