#pragma once
/// \file
/// Stress of the current state, cell by cell, for output.
#include "physics/flow.hpp"

namespace quicksand {

/// Averages over the stress points around each cell; 0 where no active element touches the cell.
struct StressFields {
  /// Effective viscosity f of (43a); where Bingham's law is rigid the penalty of the last step stands for infinity.
  CellField viscosity;
  CellField magnitude;  ///< sqrt(1/2 T:T) = f s
  /// Share of the points around the cell that have not yielded (35b): rigid in the last step under Bingham's law, below
  /// 0.99 of the yield stress under regularised laws.
  CellField unyielded;
};

template <int Dim>
StressFields evaluate_stress(const Flow<Dim>& flow);

}  // namespace quicksand
