#include "physics/rigid_iteration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "physics/dual_iteration.hpp"

namespace quicksand {

namespace {

constexpr int max_updates = 100;
/// The smooth problems are solved until their gradient takes this part of the error bound.
constexpr double gradient_share = 0.1;
/// The penalty is this many times rho L^2 / dt, L the extent of what carries stress: rigid motions of the whole are
/// then found by the first update to within a per cent or so. More makes the smooth problems harder, less takes more
/// updates.
constexpr double penalty_factor = 300;
/// Where an update does not bring the gap down to this part, the penalty grows.
constexpr double least_progress = 0.1;
constexpr double penalty_growth = 10;
/// Velocities are exact to this part of |u^| at the latest.
constexpr double negligible_speed = 1e-12;
/// The dual method takes many, cheap iterations: as many times as the others may. Beyond, a smaller step is cheaper.
constexpr int dual_iterations = 100;

double square(double x) { return x * x; }

/// Bound on 1/2 sum m |u - u*|^2.
double bound(const ViscousProgress& now) { return now.value.gap + 0.5 * square(now.norm); }

/// Error bound that round-off of the strain rates alone makes: all yield stresses at strain rates of epsilon |u| / h.
template <int Dim>
double rounding_bound(const ViscousProblem<Dim>& p) {
  const DiffusionWork<Dim>& work = p.work;
  const Grid<Dim>& grid = p.domain.grid;
  NodeField forces(grid.layout());
  for_each<Node>(grid.layout(), grid.nodes(), [&](Node n, const Index<Dim>& i) {
    if (!work.elements.active[n]) return;
    forces[n] = work.elements.rheology[n].rigid_yield_stress * work.elements.share[n] *
                work.elements.mesh.element(n, i).volume();
  });
  const double force = sum<Node>(grid.layout(), grid.nodes(), [&](Node n) { return forces[n]; });
  double fastest = 0;
  for (int d = 0; d < Dim; ++d) {
    fastest = std::max(fastest, maximum<Cell>(grid.layout(), work.matrix.box(), 0.0, [&](Cell c) {
                         return work.mass[d][c] > 0 ? std::abs(p.u_hat[d][c]) : 0.0;
                       }));
  }
  return 4 * std::numeric_limits<double>::epsilon() * p.dt * force * fastest / grid.smallest_width();
}

}  // namespace

template <int Dim>
void prepare_multipliers(const Domain<Dim>& domain, const CellField& rho, double dt, DiffusionWork<Dim>& work) {
  const Box<Dim>& box = work.matrix.box();
  const double density = maximum<Cell>(domain.layout(), box, 0.0, [&](Cell c) { return rho[c]; });
  double length = 0;
  for (int d = 0; d < Dim; ++d) {
    length = std::max(length, domain.grid.face_position(d, box.hi[d]) - domain.grid.face_position(d, box.lo[d]));
  }
  work.penalty = penalty_factor * density * length * length / dt;
  for_each<Node>(domain.layout(), domain.grid.nodes(), [&](Node n) {
    const double largest = work.elements.active[n] ? work.elements.rheology[n].rigid_yield_stress : 0.0;
    for (StrainRate<Dim>& stress : work.multiplier[n].at) limit(stress, largest);
    work.rigid_stress[n] = work.multiplier[n];
  });
}

namespace {

/// The method of multipliers: whether the error bound came down to the goal.
template <int Dim>
bool update_multipliers(ViscousProblem<Dim>& p, const DiffusionOptions& options, const ErrorGoal<Dim>& goal,
                        CellVectors<Dim>& u, DiffusionReport& report) {
  DiffusionWork<Dim>& work = p.work;
  double aim = goal(u);
  double last_gap = 0;
  for (int k = 0; k < max_updates; ++k) {
    // The smooth problem need be solved no better than the multipliers are known. One iteration at least, so that what
    // is at rest comes closer to it with every step.
    p.reached = [aim, first = k == 0](const ViscousProgress& now) mutable {
      return !std::exchange(first, false) && 0.5 * square(now.norm) <= gradient_share * std::max(now.value.gap, aim);
    };
    const bool solved = iterate(p, options.iteration, options.max_iterations, u, report);
    const ViscousProgress now = progress_at(p, u);
    for_each_stress_point(p.domain, u, work, [&](Node n, const DualElement<Dim>&, int q, const StrainRate<Dim>& s) {
      if (work.elements.rheology[n].rigid_yield_stress > 0) work.multiplier[n].at[q] = work.rigid_yield(n, q, s).stress;
    });
    ++report.multiplier_updates;
    aim = goal(u);
    report.gap = bound(now);
    if (report.gap <= aim) {
      report.stagnated = false;
      return true;
    }
    if (!solved) return false;
    if (k > 0 && now.value.gap > least_progress * last_gap) work.penalty *= penalty_growth;
    last_gap = now.value.gap;
  }
  return false;
}

}  // namespace

template <int Dim>
bool iterate_multipliers(ViscousProblem<Dim>& p, const DiffusionOptions& options, CellVectors<Dim>& u,
                         DiffusionReport& report) {
  const double negligible = std::max(0.5 * square(negligible_speed * p.speed), rounding_bound(p));
  const ErrorGoal<Dim> goal = [&](const CellVectors<Dim>& v) {
    return std::max(options.tolerance * stress_energy(p, v), negligible);
  };
  if (options.iteration != ViscousIteration::dual && update_multipliers(p, options, goal, u, report)) return true;
  report.fell_back = options.iteration != ViscousIteration::dual;
  return iterate_dual(p, goal, dual_iterations * options.max_iterations, u, report);
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                      \
  template void prepare_multipliers(const Domain<Dim>&, const CellField&, double, DiffusionWork<Dim>&); \
  template bool iterate_multipliers(ViscousProblem<Dim>&, const DiffusionOptions&, CellVectors<Dim>&, DiffusionReport&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
