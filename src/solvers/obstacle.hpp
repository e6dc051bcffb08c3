#pragma once
/// \file
/// The obstacle problem of volume redistribution.
#include <cstddef>

#include "solvers/stencil_matrix.hpp"

namespace quicksand {

struct ObstacleOptions {
  double tolerance = 1e-9;   ///< largest error of a redistributed volume fraction
  int max_iterations = 100;  ///< changes of the set of cells with H > 0, one linear solve each
};

/// What became of an obstacle problem.
struct ObstacleReport {
  bool trivial = false;       ///< no excess above the tolerance: H = 0
  int iterations = 0;         ///< outer iterations
  int cycles = 0;             ///< CG iterations, i.e. multigrid cycles, in all
  double violation = 0;       ///< largest error of a redistributed volume fraction (see ObstacleOptions::tolerance)
  std::ptrdiff_t active = 0;  ///< cells with H > 0
};

/// Finds H >= 0 with A H >= b and H (A H - b) = 0: the minimum of 1/2 H^T A H - b^T H over H >= 0, report (24)-(25).
///
/// A is -div grad in finite volume form on the cells that may receive volume (star stencil, H = 0 at open sides, zero
/// flux at closed ones), b = (phi_tilde - limit) V. Cells of the redistributed fraction phi = phi_tilde - A H / V end
/// up with phi <= limit + tolerance where H = 0 and |phi - limit| <= tolerance where H > 0. Fractions within half the
/// tolerance of the limit count as at the limit, so that the noise of other solvers neither moves volume nor costs
/// iterations.
///
/// Method: a primal-dual active set whose linear problems are solved inexactly by preconditioned conjugate gradients.
/// 1. Start from the cells near or above the limit (a full interior leaves no room) and those with H > 0.
/// 2. On the set solve A d = b - A H to one per cent while the set changes, to the tolerance once it rests.
/// 3. Project H + d on H >= 0; a line search on the functional keeps every step a descent.
/// 4. The next set has H > 0 or r = b - A H > 0. It grows ahead: what does not fit a cell outside the set passes on to
///    neighbours outside until there is room for it. Without this the set grows by one layer of cells per solve.
/// A projected Gauss-Seidel sweep replaces or repairs steps whose direction the projection spoiled.
/// \param b       right-hand side on the matrix' box
/// \param volume  cell volumes V, which turn residuals into volume fractions
/// \param H       on entry the guess on the box (last step's H or 0), on return the solution
/// \throws NumericalError when there is no solution (a closed box without room for the excess), when b is not finite or
///         when the iterations run out
template <int Dim>
ObstacleReport solve_obstacle(const StencilMatrix<Dim, Cell>& matrix, const CellField& b, const CellField& volume,
                              CellField& H, const ObstacleOptions& options = {});

}  // namespace quicksand
