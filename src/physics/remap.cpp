#include "physics/remap.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "physics/energy.hpp"
#include "physics/vector_remap.hpp"

namespace quicksand {

namespace {

template <int Dim>
void map_fractions(const GridOverlap<Dim>& overlap, const SpeciesParts<Dim>& parts, Fractions& phi) {
  const Grid<Dim>& grid = overlap.target();
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    overlap.for_parts_of_target(i, [&](const GridPart<Dim>& part) {
      parts.for_volumes(part, [&](std::size_t k, double volume) { phi[k][c] += volume / grid.volume(i); });
    });
  });
}

/// Bilinear (trilinear) interpolation to the nodes of another grid.
template <int Dim>
void interpolate_nodes(const Grid<Dim>& from, const NodeField& q, const Grid<Dim>& to, NodeField& mapped) {
  // Per axis and target node: the source cell it lies in, and where.
  std::array<std::vector<int>, Dim> cell;
  std::array<std::vector<double>, Dim> place;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    int k = 0;
    for (int i = 0; i <= to.owned_cells()[d]; ++i) {
      const double x = to.face_position(d, i);
      while (k + 1 < from.owned_cells()[d] && from.face_position(d, k + 1) <= x) ++k;
      cell[axis].push_back(k);
      place[axis].push_back(std::clamp((x - from.face_position(d, k)) / from.width_1d(d, k), 0.0, 1.0));
    }
  }
  for_each<Node>(to.layout(), to.nodes(), [&](Node n, const Index<Dim>& i) {
    double value = 0;
    for (int corner = 0; corner < (1 << Dim); ++corner) {
      Index<Dim> j;
      double weight = 1;
      for (int d = 0; d < Dim; ++d) {
        const auto axis = static_cast<std::size_t>(d);
        const auto at = static_cast<std::size_t>(i[d]);
        const bool high = ((corner >> d) & 1) != 0;
        j[d] = from.layout().image(d, cell[axis][at] + (high ? 1 : 0));
        weight *= high ? place[axis][at] : 1 - place[axis][at];
      }
      value += weight * q[Node{from.layout().flat(j)}];
    }
    mapped[n] = value;
  });
}

/// Less gas than this part of a cell is round-off.
constexpr double no_gas = 1e-12;

/// In every cell the region that most of its gas came from, 0 if there is none.
template <int Dim>
void map_regions(const GridOverlap<Dim>& overlap, const SpeciesParts<Dim>& parts, const CellLabels& region,
                 CellLabels& mapped) {
  const Grid<Dim>& grid = overlap.target();
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    std::map<int, double> from;
    overlap.for_parts_of_target(i, [&](const GridPart<Dim>& part) {
      if (region[part.source] == 0) return;
      double gas = part.volume;
      parts.for_volumes(part, [&](std::size_t, double volume) { gas -= volume; });
      from[region[part.source]] += gas;
    });
    double most = no_gas * grid.volume(i);
    for (const auto& [id, gas] : from) {
      if (gas <= most) continue;
      most = gas;
      mapped[c] = id;
    }
  });
}

/// The gas of `before`, its regions already those of the new grid, with volumes and pressures of the new grid.
template <int Dim>
std::vector<GasEvent> move_gas(const Flow<Dim>& flow, const Domain<Dim>& domain, const GasState& before,
                               const CellField& total, GasState& after) {
  GasLabels labels(domain.layout());
  std::vector<GasEvent> events =
      advance_gas(domain, flow.gas_parameters(), before, total, total, flow.state().dt, labels, after);
  for (Bubble& b : after.bubbles) {
    const auto same =
        std::find_if(before.bubbles.begin(), before.bubbles.end(), [&](const Bubble& old) { return old.id == b.id; });
    b.growth = same == before.bubbles.end() ? 0.0 : same->growth;
  }
  return events;
}

}  // namespace

template <int Dim>
Flow<Dim> remap(const Flow<Dim>& flow, Domain<Dim> domain, RemapReport& report) {
  const Grid<Dim>& from = flow.domain().grid;
  const State<Dim>& old = flow.state();
  Flow<Dim> result(std::move(domain), flow.parameters());
  const Domain<Dim>& target = result.domain();
  State<Dim>& state = result.state();

  const GridOverlap<Dim> overlap(from, target.grid);
  const SpeciesParts<Dim> parts(overlap, old.phi, flow.interfaces());
  map_fractions(overlap, parts, state.phi);
  for (std::size_t k = 0; k < state.phi.size(); ++k) fill_fraction_ghosts(target.grid, target.sides, k, state.phi[k]);
  CellField rho(target.layout());
  mix_density(target.grid, flow.parameters().species, state.phi, rho);

  const MassMap<Dim> masses(parts, overlap, flow.parameters().species, flow.total(), flow.density());
  masses.map(old.u, state.u);
  masses.map(old.acceleration, state.acceleration);
  report.kinetic_energy_before = kinetic_energy(from, flow.density(), old.u);
  lower_kinetic_energy(target, rho, report.kinetic_energy_before, state.u);
  report.kinetic_energy = kinetic_energy(target.grid, rho, state.u);
  interpolate_nodes(from, old.pressure, target.grid, state.pressure);

  if (has_bubbles(flow.gas_parameters(), old.gas)) {
    CellField total(target.layout());
    sum_fractions(target.grid, state.phi, total);
    GasState mapped(target.layout());
    map_regions(overlap, parts, old.gas.region, mapped.region);
    mapped.bubbles = old.gas.bubbles;
    mapped.last_id = old.gas.last_id;
    report.gas = move_gas(flow, target, mapped, total, state.gas);
  } else {
    state.gas.end(old.gas.last_id);
  }
  state.time = old.time;
  state.step = old.step;
  state.dt = old.dt;
  result.resume_in_place_of(flow);
  return result;
}

template Flow<2> remap(const Flow<2>&, Domain<2>, RemapReport&);
template Flow<3> remap(const Flow<3>&, Domain<3>, RemapReport&);

}  // namespace quicksand
