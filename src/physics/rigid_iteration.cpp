#include "physics/rigid_iteration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace quicksand {

namespace {

constexpr int max_updates = 100;
/// The smooth problems are solved until their gradient takes this part of the error bound.
constexpr double gradient_share = 0.1;
/// penalty = penalty_factor rho L^2 / dt
const double penalty_factor = std::getenv("PF") ? std::atof(std::getenv("PF")) : 300.0;
const bool verbose = std::getenv("VERB") != nullptr;

double square(double x) { return x * x; }

/// Bound on 1/2 sum m |u - u*|^2.
double bound(const ViscousProgress& now) { return now.value.gap + 0.5 * square(now.norm); }

/// 1/2 sum m |u - u^|^2.
template <int Dim>
double stress_energy(const ViscousProblem<Dim>& p, const CellVectors<Dim>& u) {
  double twice = 0;
  for (int d = 0; d < Dim; ++d) {
    twice += sum<Cell>(p.domain.layout(), p.work.matrix.box(),
                       [&](Cell c) { return p.work.mass[d][c] * square(u[d][c] - p.u_hat[d][c]); });
  }
  return 0.5 * twice;
}

}  // namespace

template <int Dim>
double relative_gap(const ViscousProblem<Dim>& p, const CellVectors<Dim>& u, double bound) {
  const double scale = stress_energy(p, u);
  return bound > 0 && scale > 0 ? bound / scale : 0.0;
}

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

template <int Dim>
bool iterate_multipliers(ViscousProblem<Dim>& p, const DiffusionOptions& options, CellVectors<Dim>& u,
                         DiffusionReport& report) {
  DiffusionWork<Dim>& work = p.work;
  int budget = options.max_iterations;
  const auto goal = [&](const CellVectors<Dim>& v) {
    return std::max((std::getenv("GT")?std::atof(std::getenv("GT")):1e-4) * stress_energy(p, v), 0.5 * square(1e-12 * p.speed));
  };
  double aim = goal(u);
  double last_gap = 0;
  for (int k = 0;; ++k) {
    p.reached = [&](const ViscousProgress& now) {
      return 0.5 * square(now.norm) <= gradient_share * std::max(now.value.gap, aim);
    };
    const int before = report.iterations;
    const bool smooth = iterate(p, options.iteration, budget, u, report);
    ViscousProgress now = progress_at(p, u);
    aim = goal(u);
    if (verbose)
      std::printf("   k %d newton %d gap %.3e grad %.3e aim %.3e value %.6e\n", k, report.iterations - before,
                  now.value.gap, 0.5 * square(now.norm), aim, now.value.value);
    for_each_stress_point(p.domain, u, work, [&](Node n, const DualElement<Dim>&, int q, const StrainRate<Dim>& s) {
      if (work.elements.rheology[n].rigid_yield_stress > 0) work.multiplier[n].at[q] = work.rigid_yield(n, q, s).stress;
    });
    ++report.multiplier_updates;
    report.gap = relative_gap(p, u, bound(now));
    if (bound(now) <= aim) return true;
    static const double growth = std::getenv("GROW") ? std::atof(std::getenv("GROW")) : 300.0;
    if (k > 0 && now.value.gap > 0.1 * last_gap && now.value.gap > 0.5*aim) work.penalty *= growth;
    last_gap = now.value.gap;
    if (!smooth || k == max_updates) return false;
  }
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                                   \
  template double relative_gap(const ViscousProblem<Dim>&, const CellVectors<Dim>&, double);                         \
  template void prepare_multipliers(const Domain<Dim>&, const CellField&, double, DiffusionWork<Dim>&);              \
  template bool iterate_multipliers(ViscousProblem<Dim>&, const DiffusionOptions&, CellVectors<Dim>&,                \
                                    DiffusionReport&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
