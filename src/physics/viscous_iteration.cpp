#include "physics/viscous_iteration.hpp"

#include <algorithm>
#include <cmath>

#include "core/vector_fields.hpp"
#include "physics/velocity_solver.hpp"
#include "solvers/anderson.hpp"

namespace quicksand {

namespace {

/// Newton's method gives up, in favour of Anderson's, when a line search has halved the step this often.
constexpr int max_halvings = 12;
constexpr int anderson_depth = 5;
/// Part of the functional within which a line search goes by its slopes.
constexpr double blurred = 1e-10;
/// The gradient norm bounds the distance to the minimiser, |u - u*| <= norm. Below the first of these parts of |u^|
/// nothing is left to do; an iteration that can't get on, because differences of the functional are round-off, may end
/// below the second.
constexpr double round_off = 1e-12;
constexpr double negligible = 1e-8;

/// Ratio of a linear system's diagonal to the mass, in the mean, up to which no more than the diagonal is needed before
/// it.
constexpr double stiff = 30;
constexpr int most_conjugate = 200;  ///< iterations behind the diagonal

/// Decrease of the functional that would change the velocity by round-off only.
template <int Dim>
double least_drop(const ViscousProblem<Dim>& p) {
  return round_off * round_off * p.speed * p.speed;
}

/// How an iteration that can't get on ends.
template <int Dim>
bool end_of_progress(const ViscousProblem<Dim>& p, double norm, DiffusionReport& report) {
  report.stagnated = norm <= negligible * p.speed;
  return report.stagnated;
}

/// Newton's method with backtracking on the functional; u is never worse than before.
template <int Dim>
bool iterate_newton(const ViscousProblem<Dim>& p, int max_iterations, CellVectors<Dim>& u, DiffusionReport& report) {
  DiffusionWork<Dim>& work = p.work;
  const Layout<Dim>& layout = p.domain.layout();
  ViscousProgress now = progress_at(p, u);
  double last_norm = now.norm;
  const bool linear_laws = !work.has_nonlinear_law();
  for (int k = 0; now.norm > round_off * p.speed && !p.reached(now); ++k) {
    if (k == max_iterations) return false;
    assemble_matrix(p.domain, u, p.dt, Linearisation::tangent, work);
    for (int d = 0; d < Dim; ++d) work.update[d].fill(0);
    // Inexact Newton: as accurate as the quadratic convergence seen so far deserves.
    const double seen = now.norm / last_norm;
    const double forcing = k == 0 ? 1e-2 : std::clamp(0.5 * seen * seen, 1e-4, 1e-2);
    const double enough = (linear_laws ? 0.5 : 0.1) * p.target / now.norm;
    const SolveReport linear =
        VelocitySolver<Dim>(work.matrix).solve(work.gradient, work.update, std::max(linear_laws ? 0 : forcing, enough));
    report.linear_iterations += linear.iterations;
    ++report.iterations;
    const double descent = dot<Cell>(layout, work.matrix.box(), work.gradient, work.update);
    if (std::abs(descent) <= least_drop(p)) return end_of_progress(p, now.norm, report);
    if (!(descent > 0)) return false;
    double length = 1;
    FunctionalValue trial{};
    for (int halvings = 0;; length *= 0.5, ++halvings) {
      if (halvings > max_halvings) return end_of_progress(p, now.norm, report);
      add_scaled(layout, work.matrix.box(), u, -length, work.update, work.trial);
      trial = evaluate_functional(p.domain, p.u_hat, work.trial, p.dt, work, work.trial_gradient);
      if (trial.value <= now.value.value - 1e-4 * length * descent) break;
      // Close to the minimum the values differ by round-off only, and slopes along the step must do (Hager and Zhang).
      if (trial.value <= now.value.value + blurred * std::abs(now.value.value) &&
          dot<Cell>(layout, work.matrix.box(), work.trial_gradient, work.update) >= -0.8 * descent) {
        break;
      }
    }
    update_plastic_stress(p.domain, u, work.update, work);
    std::swap(u, work.trial);
    std::swap(work.gradient, work.trial_gradient);
    last_norm = now.norm;
    now = {gradient_norm(p.domain, work, work.gradient), trial};
    if (!std::isfinite(now.norm)) return false;
  }
  return true;
}

template <int Dim>
Eigen::VectorXd pack(const ViscousProblem<Dim>& p, const CellVectors<Dim>& u) {
  const Box<Dim>& box = p.work.matrix.box();
  Eigen::VectorXd x(Dim * box.size());
  const Rows<Dim> rows(p.domain.layout(), box);
  Eigen::Index k = 0;
  for (int d = 0; d < Dim; ++d) {
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      for (int i = 0; i < rows.length; ++i) x[k++] = u[d][Cell{rows.start(r) + i}];
    }
  }
  return x;
}

template <int Dim>
void unpack(const ViscousProblem<Dim>& p, const Eigen::VectorXd& x, CellVectors<Dim>& u) {
  const Rows<Dim> rows(p.domain.layout(), p.work.matrix.box());
  Eigen::Index k = 0;
  for (int d = 0; d < Dim; ++d) {
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      for (int i = 0; i < rows.length; ++i) u[d][Cell{rows.start(r) + i}] = x[k++];
    }
  }
}

/// The report's iteration (49), plain or with Anderson acceleration.
template <int Dim>
bool iterate_picard(const ViscousProblem<Dim>& p, int max_iterations, bool accelerate, CellVectors<Dim>& u,
                    DiffusionReport& report) {
  DiffusionWork<Dim>& work = p.work;
  const Layout<Dim>& layout = p.domain.layout();
  Anderson anderson(anderson_depth);
  for (int k = 0;; ++k) {
    const ViscousProgress now = progress_at(p, u);
    if (now.norm <= round_off * p.speed || p.reached(now)) return true;
    if (k == max_iterations || !std::isfinite(now.norm)) return false;
    assemble_matrix(p.domain, u, p.dt, Linearisation::secant, work);
    for (int d = 0; d < Dim; ++d) work.update[d].fill(0);
    const SolveReport linear = VelocitySolver<Dim>(work.matrix).solve(work.gradient, work.update, 1e-3);
    report.linear_iterations += linear.iterations;
    ++report.iterations;
    if (std::abs(dot<Cell>(layout, work.matrix.box(), work.gradient, work.update)) <= least_drop(p)) {
      return end_of_progress(p, now.norm, report);
    }
    add_scaled(layout, work.matrix.box(), u, -1.0, work.update, work.trial);
    if (accelerate) {
      unpack(p, anderson.next(pack(p, u), pack(p, work.trial)), u);
    } else {
      std::swap(u, work.trial);
    }
  }
}

}  // namespace

template <int Dim>
double gradient_norm(const Domain<Dim>& domain, const DiffusionWork<Dim>& work, const CellVectors<Dim>& gradient) {
  return std::sqrt(sum<Cell>(domain.layout(), work.matrix.box(), [&](Cell c) {
    double square = 0;
    for (int d = 0; d < Dim; ++d) {
      square += work.mass[d][c] > 0 ? gradient[d][c] * gradient[d][c] / work.mass[d][c] : 0.0;
    }
    return square;
  }));
}

template <int Dim>
double stress_energy(const ViscousProblem<Dim>& p, const CellVectors<Dim>& u) {
  double twice = 0;
  for (int d = 0; d < Dim; ++d) {
    twice += sum<Cell>(p.domain.layout(), p.work.matrix.box(), [&](Cell c) {
      const double change = u[d][c] - p.u_hat[d][c];
      return p.work.mass[d][c] * change * change;
    });
  }
  return 0.5 * twice;
}

template <int Dim>
ViscousProgress progress_at(const ViscousProblem<Dim>& p, const CellVectors<Dim>& u) {
  const FunctionalValue value = evaluate_functional(p.domain, p.u_hat, u, p.dt, p.work, p.work.gradient);
  return {gradient_norm(p.domain, p.work, p.work.gradient), value};
}

template <int Dim>
std::optional<double> solve_linear_stress(const ViscousProblem<Dim>& p, double start, CellVectors<Dim>& u,
                                          DiffusionReport& report) {
  DiffusionWork<Dim>& work = p.work;
  const Layout<Dim>& layout = p.domain.layout();
  const Box<Dim>& box = work.matrix.box();
  CellVectors<Dim>& diagonal = work.trial_gradient;
  linear_stress_diagonal(p.domain, p.dt, work, diagonal);
  double inertia = 0;
  double viscosity = 0;
  for (int d = 0; d < Dim; ++d) {
    inertia += sum<Cell>(layout, box, [&](Cell c) { return work.mass[d][c]; });
    viscosity += sum<Cell>(layout, box, [&](Cell c) { return work.mass[d][c] > 0 ? diagonal[d][c] : 0.0; });
  }
  if (viscosity > stiff * inertia) return std::nullopt;
  report.method = "conjugate gradients";
  // Below round-off no target is reached.
  const double enough = std::max(p.target, round_off * p.speed);
  if (start <= enough) return start;
  const auto apply = [&](CellVectors<Dim>& v, CellVectors<Dim>& y) { apply_linear_stress(p.domain, v, p.dt, work, y); };
  const auto precondition = [&](const CellVectors<Dim>& r, CellVectors<Dim>& z) {
    for_each<Cell>(layout, box, [&](Cell c) {
      for (int d = 0; d < Dim; ++d) z[d][c] = r[d][c] / diagonal[d][c];
    });
  };
  const auto norm = [&](const CellVectors<Dim>& r) { return gradient_norm(p.domain, work, r); };
  // The gradient is A u less what it should be.
  CellVectors<Dim>& r = work.gradient;
  CellVectors<Dim> direction(layout), z(layout);
  SolveReport linear;
  double reached = start;
  for (int round = 0; round < 3 && reached > enough && linear.iterations < most_conjugate; ++round) {
    descend<Cell>(layout, box, apply, precondition, -1.0, r, u, direction, z, enough, most_conjugate, norm, linear);
    reached = progress_at(p, u).norm;
  }
  report.linear_iterations = linear.iterations;
  if (!(reached <= enough)) return std::nullopt;
  report.iterations = 1;
  return reached;
}

template <int Dim>
bool iterate(const ViscousProblem<Dim>& p, ViscousIteration method, int max_iterations, CellVectors<Dim>& u,
             DiffusionReport& report) {
  p.work.acquire_update(p.domain.layout());
  for (int d = 0; d < Dim; ++d) p.work.trial[d] = u[d];  // the iterations swap the two, and write the box only
  if (method == ViscousIteration::newton || method == ViscousIteration::dual) {
    report.method = "newton";
    if (iterate_newton(p, max_iterations, u, report)) return true;
    report.fell_back = true;
  }
  const bool accelerate = method != ViscousIteration::picard;
  report.method = accelerate ? "anderson" : "picard";
  return iterate_picard(p, 10 * max_iterations, accelerate, u, report);
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                          \
  template double gradient_norm(const Domain<Dim>&, const DiffusionWork<Dim>&, const CellVectors<Dim>&);    \
  template double stress_energy(const ViscousProblem<Dim>&, const CellVectors<Dim>&);                       \
  template ViscousProgress progress_at(const ViscousProblem<Dim>&, const CellVectors<Dim>&);                \
  template std::optional<double> solve_linear_stress(const ViscousProblem<Dim>&, double, CellVectors<Dim>&, \
                                                     DiffusionReport&);                                     \
  template bool iterate(const ViscousProblem<Dim>&, ViscousIteration, int, CellVectors<Dim>&, DiffusionReport&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
