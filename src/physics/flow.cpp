#include "physics/flow.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/errors.hpp"
#include "core/vector_fields.hpp"
#include "physics/energy.hpp"

namespace quicksand {

namespace {

/// Seconds since the last lap.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Velocities where there is no mass mean nothing; zero keeps them from spreading.
template <int Dim>
void clear_without_mass(const Grid<Dim>& grid, const CellField& rho, CellVectors<Dim>& u) {
  for (int d = 0; d < Dim; ++d) {
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c) { u[d][c] = rho[c] > 0 ? u[d][c] : 0.0; });
  }
}

/// Fluxes go to the side they point to, and what is not a number would go nowhere, unseen.
template <int Dim>
void require_finite(const Grid<Dim>& grid, const FaceScalars<Dim>& velocity) {
  double checksum = 0;
  for (int d = 0; d < Dim; ++d) {
    checksum += sum<Face>(grid.layout(), grid.faces(d), [&](Face f) { return velocity[d][f]; });
  }
  if (!std::isfinite(checksum)) throw NumericalError("the face velocities have values that are not finite");
}

/// Whether something comes in at a given velocity, and brings energy.
template <int Dim>
bool has_inflow(const Sides<Dim>& sides) {
  for (const auto& axis : sides.side) {
    for (const Side& side : axis) {
      if (side.kind == SideKind::inflow) return true;
    }
  }
  return false;
}

}  // namespace

template <int Dim>
Flow<Dim>::Flow(Domain<Dim> domain, FlowParameters<Dim> parameters)
    : domain_(std::move(domain)),
      parameters_(std::move(parameters)),
      state_(domain_.layout(), parameters_.species.size()),
      next_(state_),
      escaped_(parameters_.species.size(), 0.0),
      total_(domain_.layout()),
      rho_(domain_.layout()),
      liquid_(domain_.layout()),
      elements_(domain_.layout()),
      u_hat_(domain_.layout()),
      mac_potential_(domain_.layout()),
      redistribution_(domain_, parameters_.species),
      diffusion_(domain_, parameters_.species) {
  state_.pressure.fill(parameters_.ambient_pressure);
}

template <int Dim>
void Flow<Dim>::find_mixture(State<Dim>& state) {
  const Grid<Dim>& grid = domain_.grid;
  for (std::size_t i = 0; i < state.phi.size(); ++i) fill_fraction_ghosts(grid, domain_.sides, i, state.phi[i]);
  sum_fractions(grid, state.phi, total_);
  mix_density(grid, parameters_.species, state.phi, rho_);
  mark_liquid(grid, total_, parameters_.liquid_threshold, liquid_);
}

template <int Dim>
void Flow<Dim>::refresh() {
  const Grid<Dim>& grid = domain_.grid;
  find_mixture(state_);
  hold_open(grid, state_.gas, liquid_);
  clear_without_mass(grid, rho_, state_.u);
  fill_velocity_ghosts(domain_, state_.u);
  fill_acceleration_ghosts(grid, domain_.sides, state_.acceleration);
}

template <int Dim>
void Flow<Dim>::find_elements(const State<Dim>& state) {
  reconstruct_interfaces(domain_.grid, state.phi, interfaces_);
  mark_bearing_cells(domain_.grid, total_, elements_.bears);
  hold_open(domain_.grid, state.gas, elements_.bears);
  find_pressure_elements(domain_, parameters_.species, state.phi, total_, interfaces_, elements_);
}

template <int Dim>
void Flow<Dim>::set_outer_pressure(const GasState& gas, bool mean, NodeField& pressure) const {
  NodeField outer(domain_.layout(), parameters_.ambient_pressure);
  gas_pressure_on_nodes(domain_, gas_parameters(), gas, liquid_, mean, outer);
  set_open_pressures(domain_, outer);
  for_each<Node>(domain_.layout(), domain_.grid.nodes(), [&](Node n) {
    if (!elements_.free[n]) pressure[n] = outer[n];
  });
}

template <int Dim>
void Flow<Dim>::initialize() {
  refresh();
  if (has_bubbles(gas_parameters(), state_.gas)) {
    start_gas(domain_, gas_parameters(), total_, gas_labels_, state_.gas);
    hold_open(domain_.grid, state_.gas, liquid_);
  }
  find_elements(state_);
  set_outer_pressure(state_.gas, false, state_.pressure);
  // The pressure that balances gravity as the velocities stand: what is at rest stays so from the first step on.
  const Grid<Dim>& grid = domain_.grid;
  const double dt = 1;
  ProjectionWork<Dim> work(domain_.layout());
  for (int d = 0; d < Dim; ++d) u_hat_[d].fill(dt * parameters_.gravity[d]);
  require_converged(solve_pressure(domain_, Projected::acceleration, 0.0, u_hat_, rho_, elements_, dt,
                                   parameters_.linear, work, state_.pressure),
                    "initial pressure");
  add_pressure_gradient(domain_, state_.pressure, rho_, elements_, -dt, u_hat_);
  state_.acceleration = u_hat_;
  refresh();
  volume_ = volumes(grid, state_.phi, escaped_);
  energy_scale_ = energy_at_stake(grid, rho_, state_, parameters_.gravity);
}

template <int Dim>
void Flow<Dim>::resume(std::vector<double> escaped) {
  escaped_ = std::move(escaped);
  refresh();
  if (has_bubbles(gas_parameters(), state_.gas)) {
    label_gas(domain_, total_, parameters_.liquid_threshold, state_.gas.region, gas_labels_);
  }
  find_elements(state_);
  volume_ = volumes(domain_.grid, state_.phi, escaped_);
  energy_scale_ = energy_at_stake(domain_.grid, rho_, state_, parameters_.gravity);
}

template <int Dim>
void Flow<Dim>::resume_in_place_of(const Flow& other) {
  resume(other.escaped_);
  energy_scale_ = std::max(energy_scale_, other.energy_scale_);
  watcher_ = other.watcher_;
}

template <int Dim>
StepReport Flow<Dim>::advance(double dt) {
  try {
    return step(dt);
  } catch (const NumericalError&) {
    leave_failed_step(dt);
    throw;
  }
}

template <int Dim>
void Flow<Dim>::leave_failed_step(double dt) {
  if (parts_done_ < 3) next_.phi = state_.phi;
  if (parts_done_ < 4) next_.gas = state_.gas;
  if (parts_done_ < 5) next_.u = state_.u;
  if (next_.u[0].size() == 0) next_.u = u_hat_;  // the projection's u-bar*
  if (next_.pressure.size() == 0) next_.pressure = state_.pressure;
  if (parts_done_ < 7) next_.acceleration = state_.acceleration;
  next_.time = state_.time + dt;
  next_.step = state_.step + 1;
  next_.dt = dt;
  attempt_failed_ = true;
  // First guesses of a failed step may be what made it fail, or not finite.
  for (CellField& H_i : redistribution_.H_species) H_i.fill(0);
  mac_potential_.fill(0);
  diffusion_.stress.fill({});
  diffusion_.multiplier = multiplier_before_;
  diffusion_.penalty = penalty_before_;
  redistribution_.release();
  diffusion_.release();
  refresh();
  find_elements(state_);
  if (has_bubbles(gas_parameters(), state_.gas)) {
    label_gas(domain_, total_, parameters_.liquid_threshold, state_.gas.region, gas_labels_);
  }
}

template <int Dim>
void Flow<Dim>::project(double dt, StepReport& report) {
  const Grid<Dim>& grid = domain_.grid;
  CellVectors<Dim>& u_bar_star = u_hat_;
  u_bar_star = std::move(next_.u);
  next_.u = {};
  const double before = kinetic_energy(grid, rho_, u_bar_star);
  ProjectionWork<Dim> work(domain_.layout());
  const auto solve = [&](double memory) {
    next_.pressure = state_.pressure;
    set_outer_pressure(next_.gas, true, next_.pressure);
    SolveReport solved = solve_pressure(domain_, Projected::velocity, memory, u_bar_star, rho_, elements_, dt,
                                        parameters_.linear, work, next_.pressure);
    solved.iterations += report.projection.iterations;
    report.projection = solved;
    report.gas_work = gas_work(domain_, u_bar_star, rho_, elements_, dt, work);
    next_.u = u_bar_star;
    add_pressure_gradient(domain_, next_.pressure, rho_, elements_, -dt, next_.u);
    report.projection_energy_change = kinetic_energy(grid, rho_, next_.u) - before;
  };
  // What a yield stress holds is to stay at rest; where that costs energy the pressure is found without memory.
  if (diffusion_.has_yield_stress()) {
    solve(1);
    if (report.projection_energy_change <= report.gas_work) return;
  }
  solve(0);
}

/// One step of the report's algorithm:
///
///   u_mac                 face velocities at n+1/2: predictor with the lagged acceleration, projected in D
///   phi~, rho~ u~         convection                                       (44)
///   phi^{n+1}, H          volume redistribution, species by species        (24)-(27)
///   u-bar                 momentum redistribution                          (11)
///   u^                    gravity and lagged pressure gradient             (47)
///   u*                    implicit viscoplastic stress, theta = 1          (46)-(49)
///   u-bar*                lagged pressure gradient taken back              (52)
///   P^{n+1/2}, u^{n+1}    pressure and projection in D^{n+1}               (51), (50)
///
/// Deviates from the report: gravity acts as -dt g, not as -dt rho^{n+1/2} / rho^{n+1} g, which grows without bound
/// where a cell empties. For the same reason the lagged pressure gradient acts as the acceleration it gave to a cell in
/// the last step, and not anew over the density that the cell has now.
template <int Dim>
StepReport Flow<Dim>::step(double dt) {
  const Grid<Dim>& grid = domain_.grid;
  const FlowParameters<Dim>& par = parameters_;
  StepReport report;
  // Each is done with before the next that stands in the same field, the field's own values last, is written.
  CellVectors<Dim>& u_half = next_.acceleration;
  CellVectors<Dim>& momentum_tilde = next_.u;
  CellVectors<Dim>& u_bar = next_.acceleration;
  CellVectors<Dim>& lagged = u_hat_;  // velocity that the lagged pressure gradient gives
  Stopwatch watch;
  const auto clock = [&](Phase phase, FaceScalars<Dim>* u_mac = nullptr) {
    report.seconds[static_cast<std::size_t>(phase)] += watch.lap();
    ++parts_done_;
    if (watcher_) watcher_({parts_done_, u_mac, momentum_tilde, u_bar, next_});
  };
  std::vector<double> escaped = escaped_;
  parts_done_ = 0;
  // Until they are needed, since other phases need the memory more.
  next_.pressure = {};
  next_.u = {};
  for (CellField& phi : next_.phi) phi = {};
  multiplier_before_ = diffusion_.multiplier;
  penalty_before_ = diffusion_.penalty;

  for (int d = 0; d < Dim; ++d) lagged[d].fill(0);
  add_pressure_gradient(domain_, state_.pressure, rho_, elements_, -dt, lagged);
  {
    const ConvectionInput<Dim> in{state_.phi, total_, rho_, state_.u, state_.acceleration, liquid_, interfaces_};
    FaceScalars<Dim> u_mac(domain_.layout());
    predict_velocities(domain_, in, dt, u_half, u_mac);
    clock(Phase::convection, &u_mac);
    report.mac = project_face_velocities(domain_, rho_, liquid_, find_voids(domain_, total_, liquid_, dt), par.linear,
                                         mac_potential_, u_mac);
    clock(Phase::mac_projection, &u_mac);
    require_finite(grid, u_mac);
    for (CellField& phi : next_.phi) phi = CellField(domain_.layout());
    momentum_tilde = CellVectors<Dim>(domain_.layout());
    convect(domain_, par.species, in, dt, u_mac, u_half, next_.phi, momentum_tilde, escaped);
  }
  mix_density(grid, par.species, next_.phi, rho_);
  const double energy_tilde = kinetic_energy_of_momentum(grid, rho_, momentum_tilde);
  clock(Phase::convection);

  report.obstacle = redistribute_volume(domain_, par.species, par.obstacle, redistribution_, next_.phi, escaped);
  if (has_bubbles(gas_parameters(), state_.gas)) {
    const CellField total_before = total_;
    find_mixture(next_);
    report.gas = advance_gas(domain_, gas_parameters(), state_.gas, total_before, total_, dt, gas_labels_, next_.gas);
    hold_open(grid, next_.gas, liquid_);
  } else {
    find_mixture(next_);
    next_.gas.end(state_.gas.last_id);
  }
  find_elements(next_);
  clock(Phase::redistribute_volume);
  report.momentum = redistribute_momentum(domain_, momentum_tilde, rho_, par.momentum, redistribution_, u_bar);
  redistribution_.release();
  clock(Phase::redistribute_momentum);
  report.redistribution_energy_change = kinetic_energy(grid, rho_, u_bar) - energy_tilde;

  add_uniform(grid.layout(), grid.cells(), lagged, dt, par.gravity, u_hat_);
  add_scaled(grid.layout(), grid.cells(), u_bar, 1.0, u_hat_, u_hat_);
  CellVectors<Dim>& u_star = next_.u;
  u_star = u_hat_;
  if (mark_stress_elements(domain_, par.species, next_.phi, total_, diffusion_.elements)) {
    // The stress of the last step is the best guess of this one's.
    add_scaled(grid.layout(), grid.cells(), u_bar, dt, state_.acceleration, u_star);
    report.diffusion = diffuse(domain_, rho_, u_hat_, dt, par.diffusion, diffusion_, u_star);
    if (!report.diffusion.converged) throw NumericalError("viscoplastic diffusion did not converge");
  }
  diffusion_.release();
  clock(Phase::diffusion);

  // Less what is in u_hat besides u-bar and gravity.
  add_scaled(grid.layout(), grid.cells(), u_star, -1.0, u_hat_, u_star);
  add_scaled(grid.layout(), grid.cells(), u_star, 1.0, u_bar, u_star);
  add_uniform(grid.layout(), grid.cells(), u_star, dt, par.gravity, u_star);
  project(dt, report);
  clock(Phase::projection);
  scaled_difference(grid.layout(), grid.cells(), 1 / dt, next_.u, u_bar, next_.acceleration);
  const double energy = kinetic_energy(grid, rho_, next_.u);
  report.momentum_norm = std::sqrt(2 * energy);
  scaled_difference(grid.layout(), grid.cells(), 1 / dt, next_.u, state_.u, u_hat_);
  report.momentum_change = std::sqrt(2 * kinetic_energy(grid, rho_, u_hat_));

  require_finite(grid, next_);
  const double largest_energy = std::max({energy_scale_, energy_tilde, energy});
  report.energy_scale = std::max(largest_energy, negligible_energy(grid, rho_, dt));
  report.liquid_volume =
      sum<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) { return total_[c] * grid.volume(i); });
  const StepBalance balance{volume_,
                            volumes(grid, next_.phi, escaped),
                            report.liquid_volume,
                            report.redistribution_energy_change,
                            has_inflow(domain_.sides) ? 0.0 : report.projection_energy_change - report.gas_work,
                            report.energy_scale};
  check_balance(balance, par.species, par.guard);

  next_.time = state_.time + dt;
  next_.step = state_.step + 1;
  next_.dt = dt;
  std::swap(state_, next_);
  escaped_ = escaped;
  volume_ = balance.volume_after;
  energy_scale_ = largest_energy;
  attempt_failed_ = false;
  refresh();
  return report;
}

template class Flow<2>;
template class Flow<3>;

}  // namespace quicksand
