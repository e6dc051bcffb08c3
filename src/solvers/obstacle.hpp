#pragma once
/// \file
/// The obstacle problem of volume redistribution.
#include "solvers/stencil_matrix.hpp"

namespace quicksand {

struct ObstacleOptions {
  double tolerance = 1e-10;  ///< largest error of the redistributed volume fraction in a cell
  int max_iterations = 100;  ///< outer iterations
};

/// What became of an obstacle problem.
struct ObstacleReport {
  bool trivial = false;       ///< no excess above the tolerance: H = 0
  int iterations = 0;         ///< outer iterations
  int cycles = 0;             ///< multigrid cycles in all
  double violation = 0;       ///< largest error of the redistributed volume fraction
  std::ptrdiff_t active = 0;  ///< cells with H > 0
};

/// Finds H >= 0 with A H >= b and H (A H - b) = 0: the minimum of 1/2 H^T A H - b^T H over H >= 0, report (24)-(25).
///
/// A is -div grad in finite volume form on the cells that may receive volume (star stencil, H = 0 at open sides, zero
/// flux at closed ones), b = (phi_tilde - limit) V. Cells of the redistributed fraction phi = phi_tilde - A H / V end
/// up with phi <= limit where H = 0 and phi = limit where H > 0, both to the tolerance. \param volume  cell volumes V,
/// which turn residuals into volume fractions \param H       on entry the guess (last step's H or 0), on return the
/// solution; zero outside the box \throws NumericalError when there is no solution (excess volume in a closed box
/// without room) or none is found
template <int Dim>
ObstacleReport solve_obstacle(const StencilMatrix<Dim, Cell>& matrix, const CellField& b, const CellField& volume,
                              CellField& H, const ObstacleOptions& options = {});

}  // namespace quicksand
