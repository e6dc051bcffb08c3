#pragma once
/// \file
/// The viscous step with rigid yield stresses (Bingham's law (35)).
#include "physics/viscous_iteration.hpp"

namespace quicksand {

/// Chooses the penalty and makes the multipliers of the last step admissible for this one.
/// \param rho  density of the mixture
template <int Dim>
void prepare_multipliers(const Domain<Dim>& domain, const CellField& rho, double dt, DiffusionWork<Dim>& work);

/// Finds u* and the stresses below yield: by the method of multipliers, each of its smooth problems solved inexactly by
/// the chosen iteration, or by the dual method, which also takes over when the former fails. Stops by the duality gap.
/// \param u  guess on entry, u* on return; work.multiplier holds the stresses
/// \returns whether the gap is small enough
template <int Dim>
bool iterate_multipliers(ViscousProblem<Dim>& p, const DiffusionOptions& options, CellVectors<Dim>& u,
                         DiffusionReport& report);

}  // namespace quicksand
