#pragma once
/// \file
/// The dual method for rigid yield stresses.
#include "physics/viscous_iteration.hpp"

namespace quicksand {

/// Accelerated gradient method for the stresses of Bingham's law, with restarts (FISTA* of Treskatis, Moyers-Gonzalez
/// and Price 2016): u is the minimiser for given stresses y, which then follow the strain rate of u,
/// p <- P(y + sigma Delta), y <- p + beta (p - p_old). Slow but sure. Every element has a step sigma of its own.
///
/// For given stresses u follows from one linear system whose matrix stays (diagonal without viscosity), or from
/// Newton's method when other laws are at work beside Bingham's.
/// \param goal    error bound, as an energy, below which u suffices
/// \param u       guess on entry, result on return; work.multiplier holds the stresses
/// \returns whether the duality gap came down to the goal
template <int Dim>
bool iterate_dual(const ViscousProblem<Dim>& p, const ErrorGoal<Dim>& goal, int max_iterations, CellVectors<Dim>& u,
                  DiffusionReport& report);

}  // namespace quicksand
