#pragma once
/// \file
/// Stress of the current state, cell by cell, for output.
#include "physics/flow.hpp"

namespace quicksand {

/// Averages over the stress points around each cell; 0 where no active element touches the cell.
struct StressFields {
  CellField viscosity;  ///< effective viscosity f of (43a)
  CellField magnitude;  ///< sqrt(1/2 T:T) = f s
  CellField unyielded;  ///< share of the points around the cell whose stress is below 0.99 of the yield stress (35b)
};

template <int Dim>
StressFields evaluate_stress(const Flow<Dim>& flow);

}  // namespace quicksand
