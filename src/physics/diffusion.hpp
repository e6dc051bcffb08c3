#pragma once
/// \file
/// Implicit viscoplastic diffusion (46)-(49) with theta = 1.
///
/// u* minimises the convex functional  1/2 sum m |u - u^|^2 + dt sum_q W_q Phi(s_q)  over the cell velocities, with u^
/// of (47) without its stress, m = rho V, and Phi the potential of the law. Its gradient is the residual of (48).
///
/// Deviates from the report: Newton's method with line search in place of the iteration (49), which takes tens to
/// hundreds of steps where Newton takes five; (49) and its Anderson acceleration stay selectable, the latter is the
/// fallback. Where the material yields the functional is nearly that of total variation, |Delta|, for which Newton's
/// method is slow far from the solution; with the plastic stress as an unknown of its own (Chan, Golub and Mulet 1999)
/// it is not. The law is evaluated on the composition phi_i / sum phi at full strength: (43b) describes sand thinned by
/// water, not by void; and on phi^{n+1} where the report takes the mean with phi^n.
#include <string_view>

#include "core/domain.hpp"
#include "physics/rigid_yield.hpp"
#include "physics/solver_settings.hpp"
#include "physics/stress_elements.hpp"
#include "physics/velocity_matrix.hpp"
#include "solvers/conjugate_gradients.hpp"

namespace quicksand {

struct DiffusionOptions {
  ViscousIteration iteration = ViscousIteration::newton;
  /// Gradient norm relative to that at u^ (norm weighted by 1/m); with rigid yield stresses the error of u* relative to
  /// |u* - u^|, as the duality gap bounds it
  double tolerance = 1e-4;
  int max_iterations = 100;  ///< of Newton's method; ten times as many for the others
};

/// What became of a diffusion step.
struct DiffusionReport {
  bool converged = true;
  bool fell_back = false;  ///< another method had to take over
  bool stagnated = false;  ///< ended at round-off of the functional, short of the tolerance but at a negligible error
  int iterations = 0;      ///< nonlinear
  int linear_iterations = 0;  ///< conjugate gradients in all
  int multiplier_updates = 0;
  double residual = 0;  ///< relative gradient norm reached
  /// Bound on 1/2 sum m |u - u*|^2, the error's energy, relative to 1/2 sum m |u - u^|^2: duality gap and gradient
  double gap = 0;
  std::string_view method = "none";  ///< that ended the step
};

/// Plastic stresses at the points of an element, as symmetric tensors like StrainRate.
template <int Dim>
struct PointStresses {
  StrainRate<Dim> at[point_count<Dim>] = {};
};

/// Work arrays of the diffusion phase.
template <int Dim>
struct DiffusionWork {
  StressElements<Dim> elements;
  NodeField potential;  ///< dt W Phi summed over an element's points
  NodeField gap;        ///< dt W (tau_y s - <q, Delta>) likewise, where some species has Bingham's law
  /// The plastic stress as an unknown of its own, in the primal-dual Newton method; carried from step to step. Has a
  /// size only when some species yields.
  Field<Node, PointStresses<Dim>> stress;
  /// Rigid yield stresses: the multiplier p of rigid_yield.hpp, carried from step to step, and the estimate of q in
  /// Newton's method. Have a size only when some species has Bingham's law.
  Field<Node, PointStresses<Dim>> multiplier, rigid_stress;
  double penalty = 0;  ///< r of rigid_yield.hpp
  VelocityMatrix<Dim> matrix;
  /// m of each component in cells that take part, 0 elsewhere. A wall that holds a component takes the quarter of the
  /// cell next to it.
  CellVectors<Dim> mass;
  CellVectors<Dim> gradient, trial_gradient, update;
  CellVectors<Dim> trial;  ///< of nonlinear iterations, which make it

  /// Makes masses, gradients, potential and gap, which live within one step only, and for iterations the update; gives
  /// all such arrays back.
  void acquire(const Layout<Dim>& layout);
  void acquire_update(const Layout<Dim>& layout);
  void release();

  DiffusionWork(const Domain<Dim>& domain, const std::vector<Species>& species);

  /// Whether some species has a yield stress or shear thinning.
  bool has_nonlinear_law() const { return stress.size() > 0 || multiplier.size() > 0; }
  /// Whether some species has a yield stress, rigid or regularised.
  bool has_yield_stress() const { return stress.size() > 0 || multiplier.size() > 0; }
  /// The rigid yield stress at point q of element n for the strain rate s.
  RigidYield<Dim> rigid_yield(Node n, int q, const StrainRate<Dim>& s) const {
    return {multiplier[n].at[q], elements.rheology[n].rigid_yield_stress, penalty, s};
  }
};

/// Solves for u* after mark_stress_elements().
/// \param rho  rho^{n+1}
/// \param u    on entry the first guess, on return u*; owned cells
/// \returns    the report; not converged is the caller's to handle
template <int Dim>
DiffusionReport diffuse(const Domain<Dim>& domain, const CellField& rho, const CellVectors<Dim>& u_hat, double dt,
                        const DiffusionOptions& options, DiffusionWork<Dim>& work, CellVectors<Dim>& u);

}  // namespace quicksand
