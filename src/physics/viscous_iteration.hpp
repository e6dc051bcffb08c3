#pragma once
/// \file
/// Iterations for the minimiser of the (penalised) viscous functional.
#include <functional>
#include <optional>

#include "physics/viscous_functional.hpp"

namespace quicksand {

/// How far an iteration has come.
struct ViscousProgress {
  double norm;            ///< of the gradient, sqrt(sum r^2 / m), in which all cells count alike
  FunctionalValue value;  ///< at the same velocity
};

/// What the iterations of one step share.
template <int Dim>
struct ViscousProblem {
  const Domain<Dim>& domain;
  const CellVectors<Dim>& u_hat;
  double dt;
  DiffusionWork<Dim>& work;
  double speed;   ///< |u^| in the norm of the masses, sqrt(sum m |u^|^2)
  double target;  ///< gradient norm that surely suffices; 0 if none is known
  /// Whether the progress suffices.
  std::function<bool(const ViscousProgress&)> reached;
};

/// The error bound, as an energy, below which a velocity suffices.
template <int Dim>
using ErrorGoal = std::function<double(const CellVectors<Dim>&)>;

/// sqrt(sum r^2 / m).
template <int Dim>
double gradient_norm(const Domain<Dim>& domain, const DiffusionWork<Dim>& work, const CellVectors<Dim>& gradient);

/// 1/2 sum m |u - u^|^2, the energy of what stress does.
template <int Dim>
double stress_energy(const ViscousProblem<Dim>& p, const CellVectors<Dim>& u);

/// Functional, gradient (into work.gradient) and its norm at u.
template <int Dim>
ViscousProgress progress_at(const ViscousProblem<Dim>& p, const CellVectors<Dim>& u);

/// For linear laws: conjugate gradients behind the diagonal, without a matrix. Quick where viscosity is not stiff, that
/// is where it couples cells little more strongly than inertia holds them.
///
/// \param start  norm of the gradient at u, which is in work.gradient
/// \param u      guess on entry; on return no worse than it, with its gradient in work.gradient
/// \returns the norm reached; nothing where viscosity is stiff or the iteration does not converge
template <int Dim>
std::optional<double> solve_linear_stress(const ViscousProblem<Dim>& p, double start, CellVectors<Dim>& u,
                                          DiffusionReport& report);

/// Iterates with the given method until p.reached() or the gradient is round-off. Newton's method hands over to
/// Anderson's when its line search fails.
/// \param u       guess on entry, the best velocity found on return
/// \param report  its counts grow; its method is set
/// \returns whether p.reached(), or the velocity is off by round-off only
template <int Dim>
bool iterate(const ViscousProblem<Dim>& p, ViscousIteration method, int max_iterations, CellVectors<Dim>& u,
             DiffusionReport& report);

}  // namespace quicksand
