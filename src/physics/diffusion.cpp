#include "physics/diffusion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "physics/rigid_iteration.hpp"
#include "physics/viscous_iteration.hpp"

namespace quicksand {

namespace {

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
    for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
      work.mass[e][c] = touching(work.elements.active, domain.layout(), c) > 0 ? rho[c] * grid.volume(i) : 0.0;
    });
    for (int d = 0; d < Dim; ++d) {
      if (d == e) continue;
      const auto held = [&](int s) {
        return domain.sides.at(d, s).kind == SideKind::no_slip && grid.at_boundary(d, s);
      };
      const int last = grid.owned_cells()[d] - 1;
      for (int i = 0; i <= last; i += std::max(last, 1)) {
        double part = 1;
        for (int s = 0; s < 2; ++s) {
          if (held(s) && i == (s == 0 ? 0 : last)) part -= 1 - part_off_wall(grid, d, s, i);
        }
        Box<Dim> layer = grid.cells();
        layer.lo[d] = i;
        layer.hi[d] = i + 1;
        if (part < 1) for_each<Cell>(domain.layout(), layer, [&](Cell c) { work.mass[e][c] *= part; });
      }
    }
  }
  work.matrix.set_box(bounding_box<Cell>(domain.layout(), grid.cells(), [&](Cell c) { return work.mass[0][c] > 0; }));
}

/// sqrt(sum m |u|^2) over the box.
template <int Dim>
double mass_norm(const Domain<Dim>& domain, const DiffusionWork<Dim>& work, const CellVectors<Dim>& u) {
  double square = 0;
  for (int d = 0; d < Dim; ++d) {
    square +=
        sum<Cell>(domain.layout(), work.matrix.box(), [&](Cell c) { return work.mass[d][c] * u[d][c] * u[d][c]; });
  }
  return std::sqrt(square);
}

bool has_smooth_plasticity(const Species& s) { return rheology(s.law).is_nonlinear(); }
bool has_rigid_plasticity(const Species& s) { return rheology(s.law).rigid_yield_stress > 0; }

}  // namespace

template <int Dim>
DiffusionWork<Dim>::DiffusionWork(const Domain<Dim>& domain, const std::vector<Species>& species)
    : elements(domain), matrix(domain.layout()) {
  if (std::any_of(species.begin(), species.end(), has_smooth_plasticity)) {
    stress = Field<Node, PointStresses<Dim>>(domain.layout());
  }
  if (std::any_of(species.begin(), species.end(), has_rigid_plasticity)) {
    multiplier = Field<Node, PointStresses<Dim>>(domain.layout());
    rigid_stress = multiplier;
  }
}

template <int Dim>
void DiffusionWork<Dim>::acquire(const Layout<Dim>& layout) {
  if (potential.size() == 0) potential = NodeField(layout);
  if (gap.size() == 0 && multiplier.size() > 0) gap = potential;
  for (CellVectors<Dim>* vectors : {&mass, &gradient, &trial_gradient}) {
    if ((*vectors)[0].size() == 0) *vectors = CellVectors<Dim>(layout);
  }
}

template <int Dim>
void DiffusionWork<Dim>::acquire_update(const Layout<Dim>& layout) {
  if (update[0].size() == 0) update = CellVectors<Dim>(layout);
}

template <int Dim>
void DiffusionWork<Dim>::release() {
  elements.release();
  for (NodeField* field : {&potential, &gap}) *field = {};
  for (CellVectors<Dim>* vectors : {&mass, &gradient, &trial_gradient, &update, &trial}) *vectors = {};
}

template <int Dim>
DiffusionReport diffuse(const Domain<Dim>& domain, const CellField& rho, const CellVectors<Dim>& u_hat, double dt,
                        const DiffusionOptions& options, DiffusionWork<Dim>& work, CellVectors<Dim>& u) {
  work.acquire(domain.layout());
  mark_participants(domain, rho, work);
  for (int d = 0; d < Dim; ++d) {
    for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) {
      if (!(work.mass[d][c] > 0)) u[d][c] = u_hat[d][c];
    });
  }
  DiffusionReport report;
  if (work.matrix.box().empty()) return report;
  ViscousProblem<Dim> problem{domain, u_hat, dt, work, mass_norm(domain, work, u_hat), 0, {}};
  const bool rigid = work.multiplier.size() > 0;
  if (rigid) prepare_multipliers(domain, rho, dt, work);
  // Start from u^ or from the guess, whichever lies lower.
  const ViscousProgress hat = progress_at(problem, u_hat);
  std::swap(work.gradient, work.trial_gradient);
  ViscousProgress start = progress_at(problem, u);
  if (!(start.value.value < hat.value.value)) {
    u = u_hat;
    start = hat;
    std::swap(work.gradient, work.trial_gradient);
  }
  double reached = 0;  // norm of the gradient
  if (rigid) {
    report.converged = iterate_multipliers(problem, options, u, report);
    reached = gradient_norm(domain, work, work.gradient);
  } else {
    problem.target = options.tolerance * hat.norm;
    problem.reached = [&](const ViscousProgress& now) { return now.norm <= problem.target; };
    const std::optional<double> norm =
        work.has_nonlinear_law() ? std::nullopt : solve_linear_stress(problem, start.norm, u, report);
    report.converged = norm || iterate(problem, options.iteration, options.max_iterations, u, report);
    reached = norm ? *norm : gradient_norm(domain, work, work.gradient);
    report.gap = 0.5 * reached * reached;
  }
  const double energy = stress_energy(problem, u);
  report.gap = energy > 0 ? report.gap / energy : 0.0;
  report.residual = hat.norm > 0 ? reached / hat.norm : 0.0;
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
