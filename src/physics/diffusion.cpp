#include "physics/diffusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/vector_fields.hpp"
#include "physics/velocity_solver.hpp"
#include "physics/viscous_functional.hpp"
#include "solvers/anderson.hpp"

namespace quicksand {

namespace {

/// Newton's method gives up, in favour of Anderson's, when a line search has halved the step this often.
constexpr int max_halvings = 12;
constexpr int anderson_depth = 5;
/// A step that would change the velocity by less than this part of it is round-off: bodies in rigid motion have no
/// stress to measure a gradient against.
constexpr double smallest_change = 1e-12;

/// Number of active elements that a cell is a corner of.
template <int Dim>
int touching(const NodeMask& active, const Layout<Dim>& layout, Cell c) {
  int touched = 0;
  for (int k = 0; k < corner_count<Dim>; ++k) {
    Node n = low_node(c);
    for (int d = 0; d < Dim; ++d) {
      if ((k >> d) & 1) n = n + layout.step(d);
    }
    touched += active[n];
  }
  return touched;
}

/// Part of the cells in layer i along axis d that lies nearer to the cell's centre than to a wall on side s.
template <int Dim>
double part_off_wall(const Grid<Dim>& grid, int d, int s, int i) {
  if (!grid.axisymmetric() || d != 0) return 0.75;
  const double r = grid.centre_position(0, i);
  const double middle = r + (s == 0 ? 1 : -1) * grid.width_1d(0, i) / 8;  // of the remaining three quarters
  return 0.75 * middle / r;
}

/// Masses of the cells that active elements touch, and the box around them.
///
/// With linear elements the load next to a held boundary point is shared between it and the cell's centre. Left to the
/// cell alone it makes the velocity at a wall too large by an eighth of h^2 times its second derivative; shared, a
/// parabola is exact, in the plane as in the tube.
template <int Dim>
void mark_participants(const Domain<Dim>& domain, const CellField& rho, DiffusionWork<Dim>& work) {
  const Grid<Dim>& grid = domain.grid;
  for (int e = 0; e < Dim; ++e) {
    for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c) {
      work.mass[e][c] = touching(work.elements.active, domain.layout(), c) > 0 ? rho[c] * grid.volume(c) : 0.0;
    });
    for (int d = 0; d < Dim; ++d) {
      for (int s = 0; s < 2; ++s) {
        if (d == e || domain.sides.at(d, s).kind != SideKind::no_slip || !grid.at_boundary(d, s)) continue;
        Box<Dim> layer = grid.cells();
        (s == 0 ? layer.hi[d] : layer.lo[d]) = s == 0 ? 1 : grid.owned_cells()[d] - 1;
        const double part = part_off_wall(grid, d, s, layer.lo[d]);
        for_each<Cell>(domain.layout(), layer, [&](Cell c) { work.mass[e][c] *= part; });
      }
    }
  }
  work.matrix.set_box(bounding_box<Cell>(domain.layout(), grid.cells(), [&](Cell c) { return work.mass[0][c] > 0; }));
}

/// sqrt(sum r^2 / m): the gradient norm in which all cells count alike.
template <int Dim>
double gradient_norm(const Domain<Dim>& domain, const DiffusionWork<Dim>& work, const CellVectors<Dim>& gradient) {
  double square = 0;
  for (int d = 0; d < Dim; ++d) {
    square += sum<Cell>(domain.layout(), work.matrix.box(), [&](Cell c) {
      return work.mass[d][c] > 0 ? gradient[d][c] * gradient[d][c] / work.mass[d][c] : 0.0;
    });
  }
  return std::sqrt(square);
}

/// What the nonlinear iterations share.
template <int Dim>
struct Problem {
  const Domain<Dim>& domain;
  const CellVectors<Dim>& u_hat;
  double dt;
  DiffusionWork<Dim>& work;
  double target;      ///< gradient norm to reach
  double least_drop;  ///< decrease of the functional that is round-off
};

/// Newton's method with backtracking on the functional. Returns whether the target was reached; u is never worse than
/// before.
template <int Dim>
bool iterate_newton(const Problem<Dim>& p, int max_iterations, CellVectors<Dim>& u, DiffusionReport& report) {
  DiffusionWork<Dim>& work = p.work;
  double value = evaluate_functional(p.domain, p.u_hat, u, p.dt, work, work.gradient);
  double norm = gradient_norm(p.domain, work, work.gradient);
  double last_norm = norm;
  for (int k = 0; norm > p.target; ++k) {
    if (k == max_iterations) return false;
    assemble_matrix(p.domain, u, p.dt, Linearisation::tangent, work);
    for (int d = 0; d < Dim; ++d) work.update[d].fill(0);
    // Inexact Newton: as accurate as the quadratic convergence seen so far deserves.
    const double forcing = k == 0 ? 1e-2 : std::clamp(0.5 * (norm / last_norm) * (norm / last_norm), 1e-4, 1e-2);
    const SolveReport linear =
        solve_velocity(work.matrix, work.gradient, work.update, std::max(forcing, 0.1 * p.target / norm));
    report.linear_iterations += linear.iterations;
    ++report.iterations;
    const double descent = dot<Cell>(p.domain.layout(), work.matrix.box(), work.gradient, work.update);
    if (std::abs(descent) <= p.least_drop) return true;
    if (!(descent > 0)) return false;
    // Differences of the functional below its round-off can't tell better from worse.
    const double noise = 1e-13 * std::abs(value);
    double length = 1;
    double trial_value = 0;
    int halvings = 0;
    for (;; length *= 0.5, ++halvings) {
      if (halvings > max_halvings) return false;
      add_scaled(p.domain.layout(), work.matrix.box(), u, -length, work.update, work.trial);
      trial_value = evaluate_functional(p.domain, p.u_hat, work.trial, p.dt, work, work.trial_gradient);
      if (trial_value <= value - 1e-4 * length * descent + noise) break;
    }
    update_plastic_stress(p.domain, u, work.update, work);
    std::swap(u, work.trial);
    std::swap(work.gradient, work.trial_gradient);
    value = trial_value;
    last_norm = norm;
    norm = gradient_norm(p.domain, work, work.gradient);
    if (!std::isfinite(norm)) return false;
  }
  return true;
}

template <int Dim>
Eigen::VectorXd pack(const Problem<Dim>& p, const CellVectors<Dim>& u) {
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
void unpack(const Problem<Dim>& p, const Eigen::VectorXd& x, CellVectors<Dim>& u) {
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
bool iterate_picard(const Problem<Dim>& p, int max_iterations, bool accelerate, CellVectors<Dim>& u,
                    DiffusionReport& report) {
  DiffusionWork<Dim>& work = p.work;
  Anderson anderson(anderson_depth);
  for (int k = 0;; ++k) {
    evaluate_functional(p.domain, p.u_hat, u, p.dt, work, work.gradient);
    const double norm = gradient_norm(p.domain, work, work.gradient);
    if (norm <= p.target) return true;
    if (k == max_iterations || !std::isfinite(norm)) return false;
    assemble_matrix(p.domain, u, p.dt, Linearisation::secant, work);
    for (int d = 0; d < Dim; ++d) work.update[d].fill(0);
    const SolveReport linear = solve_velocity(work.matrix, work.gradient, work.update, 1e-3);
    report.linear_iterations += linear.iterations;
    ++report.iterations;
    if (std::abs(dot<Cell>(p.domain.layout(), work.matrix.box(), work.gradient, work.update)) <= p.least_drop)
      return true;
    add_scaled(p.domain.layout(), work.matrix.box(), u, -1.0, work.update, work.trial);
    if (accelerate) {
      unpack(p, anderson.next(pack(p, u), pack(p, work.trial)), u);
    } else {
      std::swap(u, work.trial);
    }
  }
}

}  // namespace

template <int Dim>
DiffusionWork<Dim>::DiffusionWork(const Domain<Dim>& domain, const std::vector<Species>& species)
    : elements(domain),
      potential(domain.layout()),
      matrix(domain.layout()),
      mass(domain.layout()),
      gradient(domain.layout()),
      trial_gradient(domain.layout()),
      update(domain.layout()),
      trial(domain.layout()) {
  const bool plastic =
      std::any_of(species.begin(), species.end(), [](const Species& s) { return rheology(s.law).yield_stress > 0; });
  if (plastic) stress = Field<Node, PointStresses<Dim>>(domain.layout());
}

template <int Dim>
DiffusionReport diffuse(const Domain<Dim>& domain, const CellField& rho, const CellVectors<Dim>& u_hat, double dt,
                        const DiffusionOptions& options, DiffusionWork<Dim>& work, CellVectors<Dim>& u) {
  mark_participants(domain, rho, work);
  for (int d = 0; d < Dim; ++d) {
    for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) {
      if (!(work.mass[d][c] > 0)) u[d][c] = u_hat[d][c];
    });
  }
  DiffusionReport report;
  if (work.matrix.box().empty()) return report;
  double twice_energy = 0;
  for (int d = 0; d < Dim; ++d) {
    twice_energy += sum<Cell>(domain.layout(), work.matrix.box(),
                              [&](Cell c) { return work.mass[d][c] * u_hat[d][c] * u_hat[d][c]; });
  }
  Problem<Dim> problem{domain, u_hat, dt, work, 0, smallest_change * smallest_change * twice_energy};
  // Start from u^ or from the guess, whichever lies lower.
  const double value_hat = evaluate_functional(domain, u_hat, u_hat, dt, work, work.gradient);
  const double norm_hat = gradient_norm(domain, work, work.gradient);
  problem.target = options.tolerance * norm_hat;
  if (!(evaluate_functional(domain, u_hat, u, dt, work, work.gradient) < value_hat)) u = u_hat;
  work.trial = u;  // the iterations swap the two, and write the box only

  switch (options.iteration) {
    case ViscousIteration::newton:
      report.converged = iterate_newton(problem, options.max_iterations, u, report);
      if (!report.converged) {
        report.fell_back = true;
        report.converged = iterate_picard(problem, 10 * options.max_iterations, true, u, report);
      }
      break;
    case ViscousIteration::anderson:
      report.converged = iterate_picard(problem, 10 * options.max_iterations, true, u, report);
      break;
    case ViscousIteration::picard:
      report.converged = iterate_picard(problem, 10 * options.max_iterations, false, u, report);
      break;
  }
  report.residual = norm_hat > 0 ? gradient_norm(domain, work, work.gradient) / norm_hat : 0.0;
  return report;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                        \
  template struct DiffusionWork<Dim>;                                                                     \
  template DiffusionReport diffuse(const Domain<Dim>&, const CellField&, const CellVectors<Dim>&, double, \
                                   const DiffusionOptions&, DiffusionWork<Dim>&, CellVectors<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
