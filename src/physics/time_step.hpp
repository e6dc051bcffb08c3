#pragma once
/// \file
/// The largest step the explicit convection may take.
#include "physics/flow.hpp"

namespace quicksand {

/// Largest dt for which no cell's content moves further than cfl cell widths: v dt + a dt^2 / 2 <= cfl, with v and a
/// the velocity and acceleration in cell widths; the acceleration is the last step's, and at least gravity. Cells that
/// count as empty do not bound the step: their outflow is limited to what they hold.
template <int Dim>
double stable_step(const Flow<Dim>& flow, double cfl);

}  // namespace quicksand
