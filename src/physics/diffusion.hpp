#pragma once
/// \file
/// Implicit viscoplastic diffusion (46)-(49) with theta = 1.
///
/// u* minimises the convex functional  1/2 sum m |u - u^|^2 + dt sum_q W_q Phi(s_q)  over the cell velocities, with u^ of
/// (47) without its stress, m = rho V, and Phi the potential of the law. Its gradient is the residual of (48).
///
/// Deviates from the report: Newton's method with line search in place of the iteration (49), which takes tens to hundreds of
/// steps where Newton takes five; (49) and its Anderson acceleration stay selectable, the latter is the fallback. The law is
/// evaluated on the composition phi_i / sum phi at full strength: (43b) describes sand thinned by water, not by void.
#include <vector>

#include "core/domain.hpp"
#include "physics/dual_element.hpp"
#include "physics/mixture.hpp"
#include "physics/velocity_matrix.hpp"
#include "solvers/conjugate_gradients.hpp"

namespace quicksand {

enum class ViscousIteration { newton, anderson, picard };

struct DiffusionOptions {
  ViscousIteration iteration = ViscousIteration::newton;
  double tolerance = 1e-6;   ///< gradient norm relative to that at u^ (norm weighted by 1/m)
  int max_iterations = 100;  ///< of Newton's method; ten times as many for the others
};

/// What became of a diffusion step.
struct DiffusionReport {
  bool converged = true;
  bool fell_back = false;     ///< Newton gave up and Anderson took over
  int iterations = 0;         ///< nonlinear
  int linear_iterations = 0;  ///< conjugate gradients in all
  double residual = 0;        ///< relative gradient norm reached
};

/// Work arrays of the diffusion phase.
template <int Dim>
struct DiffusionWork {
  DualMesh<Dim> mesh;
  NodeMask active;                 ///< elements that carry stress
  Field<Node, Rheology> rheology;  ///< of each element
  NodeField potential;             ///< dt W Phi summed over an element's points
  VelocityMatrix<Dim> matrix;
  CellField mass;                  ///< m in cells that take part, 0 elsewhere
  CellVectors<Dim> gradient, trial_gradient, update, trial;

  explicit DiffusionWork(const Domain<Dim>& domain);
};

/// Rheology of every element from the mean composition c_i = phi_i / sum phi of its corner cells: viscosities and yield
/// stresses of all species, each times (43b), add up; alpha is the mean weighted by yield stress. Elements that touch an
/// empty cell, or whose law is inviscid, are inactive.
/// \returns whether any element is active
template <int Dim>
bool mix_rheology(const Domain<Dim>& domain, const std::vector<Species>& species, const Fractions& phi,
                  const CellField& total, DiffusionWork<Dim>& work);

/// The factor of (43b): (exp(kappa c) - 1) / (exp(kappa) - 1), c for kappa = 0.
double concentration_factor(double kappa, double c);

/// Solves for u* after mix_rheology().
/// \param rho  rho^{n+1}
/// \param u    on entry the first guess, on return u*; owned cells
/// \returns    the report; not converged is the caller's to handle
template <int Dim>
DiffusionReport diffuse(const Domain<Dim>& domain, const CellField& rho, const CellVectors<Dim>& u_hat, double dt,
                        const DiffusionOptions& options, DiffusionWork<Dim>& work, CellVectors<Dim>& u);

}  // namespace quicksand
