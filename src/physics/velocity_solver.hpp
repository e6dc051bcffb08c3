#pragma once
/// \file
/// Linear systems of the viscous step.
#include "physics/velocity_matrix.hpp"
#include "solvers/conjugate_gradients.hpp"

namespace quicksand {

/// Solves matrix x = b from the guess x: small plane systems by sparse Cholesky factors, the others by conjugate
/// gradients with one multigrid cycle per component as preconditioner. \param matrix  symmetric positive definite
/// \param relative_tolerance  of the residual; factors reach round-off
template <int Dim>
[[nodiscard]] SolveReport solve_velocity(const VelocityMatrix<Dim>& matrix, const CellVectors<Dim>& b,
                                         CellVectors<Dim>& x, double relative_tolerance);

}  // namespace quicksand
