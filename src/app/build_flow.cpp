#include "app/build_flow.hpp"

#include <algorithm>

#include "app/grid_sequence.hpp"
#include "app/initial_bubbles.hpp"

namespace quicksand {

namespace {

template <int Dim>
FlowParameters<Dim> parameters_of(const CaseConfig& config) {
  FlowParameters<Dim> p;
  p.species = config.species;
  p.gravity = in_axes<Dim>(config.gravity);
  p.ambient_pressure = config.ambient_pressure;
  p.trapped_gas = config.trapped_gas;
  p.liquid_threshold = config.solver.liquid_threshold;
  p.linear.relative = config.solver.tolerance;
  p.linear.max_iterations = config.solver.max_iterations;
  p.obstacle.tolerance = config.solver.tolerance;
  p.diffusion.iteration = config.solver.viscous_iteration;
  p.diffusion.tolerance = config.solver.viscous_tolerance;
  p.diffusion.max_iterations = config.solver.viscous_max_iterations;
  p.guard = config.guard;
  // Solves that are less accurate keep the energy less well.
  p.guard.energy_rise = std::max(config.guard.energy_rise, config.solver.tolerance);
  return p;
}

/// A cell with a greater part of a bubble has no liquid: no film of round-off stays.
constexpr double full = 1 - 1e-12;

/// Fills the shapes one after the other; what does not fit on top of earlier ones (round-off of touching shapes) is
/// left out.
template <int Dim>
void fill_shapes(const CaseConfig& config, Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  State<Dim>& state = flow.state();
  CellField filled(grid.layout());
  CellField mass(grid.layout());
  for (const InitialFill& fill : config.initial) {
    const std::size_t s = species_number(config, fill.fill);
    const Vec<Dim> velocity = in_axes<Dim>(fill.velocity);
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
      const double part = std::min(fraction(fill.shape, grid, i), 1 - filled[c]);
      if (!(part > 0)) return;
      state.phi[s][c] += part;
      filled[c] += part;
      const double added = part * config.species[s].density;
      for (int d = 0; d < Dim; ++d) {
        state.u[d][c] = (mass[c] * state.u[d][c] + added * velocity[d]) / (mass[c] + added);
      }
      mass[c] += added;
    });
  }
}

/// Cuts the bubbles, those of charges too, out of the liquid and marks their cells.
template <int Dim>
void cut_bubbles(const CaseConfig& config, Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  State<Dim>& state = flow.state();
  for (const InitialBubble& bubble : initial_bubbles(config)) {
    const Shape ball = SphereShape{bubble.center, bubble.radius};
    const int id = ++state.gas.last_id;
    state.gas.bubbles.push_back({.id = id, .exponent = bubble.adiabatic_exponent, .pressure = bubble.pressure});
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
      const double gas = fraction(ball, grid, i);
      for (CellField& phi : state.phi) phi[c] *= gas < full ? 1 - gas : 0.0;
      if (gas > 0.5) state.gas.region[c] = id;
    });
  }
}

}  // namespace

template <int Dim>
Flow<Dim> empty_flow(const CaseConfig& config, Domain<Dim> domain) {
  return {std::move(domain), parameters_of<Dim>(config)};
}

template <int Dim>
Flow<Dim> build_flow(const CaseConfig& config, Domain<Dim> domain) {
  Flow<Dim> flow = empty_flow<Dim>(config, std::move(domain));
  fill_shapes(config, flow);
  cut_bubbles(config, flow);
  flow.initialize();
  return flow;
}

template <int Dim>
Flow<Dim> build_flow(const CaseConfig& config) {
  return build_flow<Dim>(config, GridSequence<Dim>(config).first());
}

template Flow<2> empty_flow<2>(const CaseConfig&, Domain<2>);
template Flow<3> empty_flow<3>(const CaseConfig&, Domain<3>);
template Flow<2> build_flow<2>(const CaseConfig&, Domain<2>);
template Flow<3> build_flow<3>(const CaseConfig&, Domain<3>);
template Flow<2> build_flow<2>(const CaseConfig&);
template Flow<3> build_flow<3>(const CaseConfig&);

}  // namespace quicksand
