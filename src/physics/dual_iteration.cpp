#include "physics/dual_iteration.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "core/vector_fields.hpp"
#include "physics/velocity_solver.hpp"

namespace quicksand {

namespace {

/// The gap costs a pass over the elements, a third of an iteration.
constexpr int iterations_per_check = 5;
/// Part of the error bound up to which Newton's method solves for u at given stresses.
constexpr double gradient_share = 0.01;
constexpr int most_newton = 50;

/// The minimiser over u for stresses that are given in work.multiplier.
template <int Dim>
class PrimalStep {
 public:
  explicit PrimalStep(const ViscousProblem<Dim>& p) : problem_(p) {
    const Layout<Dim>& layout = p.domain.layout();
    p.work.acquire_update(layout);
    const DiffusionWork<Dim>& work = p.work;
    const auto any = [&](auto&& has) {
      return maximum<Node>(layout, p.domain.grid.nodes(), 0.0, [&](Node n) {
               return work.elements.active[n] && has(work.elements.rheology[n]) ? 1.0 : 0.0;
             }) > 0;
    };
    linear_ = !any([](const Rheology& r) { return r.is_nonlinear(); });
    if (linear_ && any([](const Rheology& r) { return r.viscosity > 0; })) {
      assemble_matrix(p.domain, p.u_hat, p.dt, Linearisation::secant, p.work);
      solver_.emplace(p.work.matrix);
    }
  }

  /// \param accuracy  of the energy, where Newton's method is at work
  bool operator()(double accuracy, CellVectors<Dim>& u, DiffusionReport& report) {
    DiffusionWork<Dim>& work = problem_.work;
    const Layout<Dim>& layout = problem_.domain.layout();
    const Box<Dim>& box = work.matrix.box();
    if (!linear_) {
      problem_.reached = [accuracy](const ViscousProgress& now) { return 0.5 * now.norm * now.norm <= accuracy; };
      return iterate(problem_, ViscousIteration::newton, most_newton, u, report);
    }
    ++report.iterations;
    progress_at(problem_, u);
    if (solver_) {
      for (int d = 0; d < Dim; ++d) work.update[d].fill(0);
      const SolveReport linear = solver_->solve(work.gradient, work.update, 1e-6);
      report.linear_iterations += linear.iterations;
      if (!linear.converged) return false;
    } else {
      for (int d = 0; d < Dim; ++d) {
        for_each<Cell>(layout, box, [&](Cell c) {
          work.update[d][c] = work.mass[d][c] > 0 ? work.gradient[d][c] / work.mass[d][c] : 0.0;
        });
      }
    }
    add_scaled(layout, box, u, -1.0, work.update, u);
    return true;
  }

 private:
  ViscousProblem<Dim> problem_;
  bool linear_;
  std::optional<VelocitySolver<Dim>> solver_;
};

/// The iteration, where work.multiplier is the stress itself.
template <int Dim>
bool follow_strain(const ViscousProblem<Dim>& p, const ErrorGoal<Dim>& goal, int max_iterations, CellVectors<Dim>& u,
                   DiffusionReport& report) {
  DiffusionWork<Dim>& work = p.work;
  const Layout<Dim>& layout = p.domain.layout();
  const NodeField step = dual_steps(p.domain, p.dt, work);
  PrimalStep<Dim> solve_primal(p);
  using Stresses = Field<Node, PointStresses<Dim>>;
  Stresses stress = work.multiplier;  // p; work.multiplier is y where u is solved for
  NodeField uphill(layout);           // <y - p, p - p_old>, per element
  double momentum = 1;
  double accuracy = gradient_share * goal(p.u_hat);
  for (int k = 1; k <= max_iterations; ++k) {
    if (!solve_primal(accuracy, u, report)) return false;
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * momentum * momentum));
    const double beta = (momentum - 1) / next;
    momentum = next;
    uphill.fill(0);
    for_each_stress_point(p.domain, u, work, [&](Node n, const DualElement<Dim>& e, int q, const StrainRate<Dim>& s) {
      const double yield_stress = work.elements.rheology[n].rigid_yield_stress;
      if (!(yield_stress > 0)) return;
      StrainRate<Dim>& old = stress[n].at[q];
      StrainRate<Dim>& extrapolated = work.multiplier[n].at[q];
      StrainRate<Dim> fresh = add_scaled(extrapolated, step[n], s);
      limit(fresh, yield_stress);
      const StrainRate<Dim> change = add_scaled(fresh, -1, old);
      uphill[n] += work.elements.share[n] * e.weight(q) / step[n] * inner(add_scaled(extrapolated, -1, fresh), change);
      extrapolated = add_scaled(fresh, beta, change);
      old = fresh;
    });
    if (sum<Node>(layout, p.domain.grid.nodes(), [&](Node n) { return uphill[n]; }) > 0) {
      momentum = 1;
      work.multiplier = stress;
    }
    if (k % iterations_per_check != 0 && k < max_iterations) continue;
    std::swap(work.multiplier, stress);
    const ViscousProgress now = progress_at(p, u);
    const double aim = goal(u);
    report.gap = now.value.gap + 0.5 * now.norm * now.norm;
    if (!std::isfinite(report.gap)) return false;
    if (report.gap <= aim) return true;
    std::swap(work.multiplier, stress);
    accuracy = gradient_share * aim;
  }
  work.multiplier = stress;
  return false;
}

}  // namespace

template <int Dim>
bool iterate_dual(const ViscousProblem<Dim>& p, const ErrorGoal<Dim>& goal, int max_iterations, CellVectors<Dim>& u,
                  DiffusionReport& report) {
  report.method = "dual";
  const double penalty = std::exchange(p.work.penalty, 0.0);
  const bool reached = follow_strain(p, goal, max_iterations, u, report);
  p.work.penalty = penalty;
  return reached;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                      \
  template bool iterate_dual(const ViscousProblem<Dim>&, const ErrorGoal<Dim>&, int, CellVectors<Dim>&, \
                             DiffusionReport&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
