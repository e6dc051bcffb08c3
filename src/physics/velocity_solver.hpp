#pragma once
/// \file
/// Linear systems of the viscous step.
#include <memory>

#include "physics/velocity_matrix.hpp"
#include "solvers/conjugate_gradients.hpp"

namespace quicksand {

/// Systems whose neighbours' numbers differ by no more than this are factorised.
inline constexpr int widest_velocity_band = 144;

/// A matrix made ready to be solved any number of times: slender systems by banded Cholesky factors, the others by
/// conjugate gradients with one multigrid cycle per component as preconditioner.
template <int Dim>
class VelocitySolver {
 public:
  /// \param matrix  symmetric positive definite; must neither change nor go while the solver is in use
  explicit VelocitySolver(const VelocityMatrix<Dim>& matrix);
  ~VelocitySolver();
  VelocitySolver(VelocitySolver&&) noexcept;
  VelocitySolver& operator=(VelocitySolver&&) noexcept;

  /// Solves matrix x = b from the guess x. \param relative_tolerance  of the residual; factors reach round-off
  [[nodiscard]] SolveReport solve(const CellVectors<Dim>& b, CellVectors<Dim>& x, double relative_tolerance);

 private:
  struct Factors;
  struct Cycles;
  const VelocityMatrix<Dim>* matrix_;
  std::unique_ptr<Factors> factors_;
  std::unique_ptr<Cycles> cycles_;  ///< set up when the factors can't do
};

}  // namespace quicksand
