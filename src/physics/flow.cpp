#include "physics/flow.hpp"

#include <chrono>
#include <cmath>

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

template <int Dim>
void require_finite(const Grid<Dim>& grid, const State<Dim>& state) {
  const double checksum = sum<Cell>(grid.layout(), grid.cells(), [&](Cell c) {
    double total = 0;
    for (const CellField& phi_i : state.phi) total += phi_i[c];
    for (int d = 0; d < Dim; ++d) total += state.u[d][c];
    return total;
  });
  if (!std::isfinite(checksum)) throw NumericalError("the flow has values that are not finite");
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
      next_total_(domain_.layout()),
      next_rho_(domain_.layout()),
      next_liquid_(domain_.layout()),
      momentum_tilde_(domain_.layout()),
      u_bar_(domain_.layout()),
      u_hat_(domain_.layout()),
      face_velocities_(domain_.layout()),
      convection_(domain_.layout(), parameters_.species.size()),
      mac_(domain_.layout()),
      redistribution_(domain_, parameters_.species),
      diffusion_(domain_, parameters_.species),
      projection_(domain_.layout()),
      outer_pressure_(domain_.layout(), parameters_.ambient_pressure),
      pressure_change_(domain_.layout()),
      no_pressure_(domain_.layout()) {
  state_.pressure.fill(parameters_.ambient_pressure);
}

template <int Dim>
void Flow<Dim>::refresh() {
  const Grid<Dim>& grid = domain_.grid;
  for (CellField& phi_i : state_.phi) fill_fraction_ghosts(grid, domain_.sides, phi_i);
  sum_fractions(grid, state_.phi, total_);
  mix_density(grid, parameters_.species, state_.phi, rho_);
  mark_liquid(grid, total_, parameters_.liquid_threshold, liquid_);
  clear_without_mass(grid, rho_, state_.u);
  fill_velocity_ghosts(grid, domain_.sides, state_.u);
  fill_velocity_ghosts(grid, domain_.sides, state_.acceleration);
}

template <int Dim>
void Flow<Dim>::initialize() {
  refresh();
  mark_stress_elements(domain_, parameters_.species, state_.phi, total_, diffusion_.elements);
  // The pressure that balances gravity as the velocities stand: what is at rest stays so from the first step on.
  const Grid<Dim>& grid = domain_.grid;
  const CellVectors<Dim> none(domain_.layout());
  const double dt = 1;
  add_uniform(grid.layout(), grid.cells(), none, dt, parameters_.gravity, u_hat_);
  require_converged(solve_pressure(domain_, u_hat_, rho_, liquid_, outer_pressure_, dt, parameters_.linear, projection_,
                                   state_.pressure),
                    "initial pressure");
  add_pressure_gradient(domain_, state_.pressure, rho_, liquid_, -dt, u_hat_);
  state_.acceleration = u_hat_;
  refresh();
}

template <int Dim>
StepReport Flow<Dim>::advance(double dt) {
  try {
    return step(dt);
  } catch (const NumericalError&) {
    forget_failed_step();
    throw;
  }
}

template <int Dim>
void Flow<Dim>::forget_failed_step() {
  for (CellField& H_i : redistribution_.H_species) H_i.fill(0);
  mac_.potential.fill(0);
  diffusion_.stress.fill({});
  diffusion_.multiplier.fill({});
  mark_stress_elements(domain_, parameters_.species, state_.phi, total_, diffusion_.elements);
}

/// One step of the report's algorithm:
///
///   u_mac                 face velocities at n+1/2: predictor with the lagged acceleration, projected in D
///   phi~, rho~ u~         convection                                       (44)
///   phi^{n+1}, H          volume redistribution, species by species        (24)-(27)
///   u-bar                 momentum redistribution                          (11)
///   u^                    gravity and lagged pressure gradient             (47)
///   u*                    implicit viscoplastic stress, theta = 1          (46)-(49)
///   P^{n+1/2}, u^{n+1}    pressure and projection in D^{n+1}               (52), (51), (50)
///
/// Deviates from the report: the projection (51) is solved for the change of P on u*, not for P itself on u-bar*. The
/// divergence of an element's mean gradient is not quite the matrix of (51), and where P itself is solved for the
/// difference acts in every step: a slurry whose u* is at rest would keep creeping, at a speed proportional to dt.
///
/// Deviates from the report: gravity acts as -dt g, not as -dt rho^{n+1/2} / rho^{n+1} g, which grows without bound
/// where a cell empties.
template <int Dim>
StepReport Flow<Dim>::step(double dt) {
  const Grid<Dim>& grid = domain_.grid;
  const FlowParameters<Dim>& par = parameters_;
  StepReport report;
  Stopwatch watch;
  const auto clock = [&](Phase phase) { report.seconds[static_cast<std::size_t>(phase)] += watch.lap(); };
  std::vector<double> escaped = escaped_;

  const ConvectionInput<Dim> in{state_.phi, total_, rho_, state_.u, state_.acceleration, liquid_};
  predict_velocities(domain_, in, dt, convection_, face_velocities_);
  clock(Phase::convection);
  report.mac = project_face_velocities(domain_, rho_, liquid_, par.linear, mac_, face_velocities_.mac);
  clock(Phase::mac_projection);
  split_velocities(domain_, in, convection_, face_velocities_);
  convect(domain_, par.species, in, dt, face_velocities_, convection_, next_.phi, momentum_tilde_, escaped);
  mix_density(grid, par.species, next_.phi, next_rho_);
  const double energy_tilde = kinetic_energy_of_momentum(grid, next_rho_, momentum_tilde_);
  clock(Phase::convection);

  report.obstacle = redistribute_volume(domain_, par.species, par.obstacle, redistribution_, next_.phi, escaped);
  for (CellField& phi_i : next_.phi) fill_fraction_ghosts(grid, domain_.sides, phi_i);
  sum_fractions(grid, next_.phi, next_total_);
  mix_density(grid, par.species, next_.phi, next_rho_);
  mark_liquid(grid, next_total_, par.liquid_threshold, next_liquid_);
  clock(Phase::redistribute_volume);
  report.momentum = redistribute_momentum(domain_, momentum_tilde_, next_rho_, par.momentum, redistribution_, u_bar_);
  report.redistribution_energy_change = kinetic_energy(grid, next_rho_, u_bar_) - energy_tilde;
  clock(Phase::redistribute_momentum);

  next_.pressure = state_.pressure;
  apply_outer_pressure(domain_, next_liquid_, outer_pressure_, projection_, next_.pressure);
  add_uniform(grid.layout(), grid.cells(), u_bar_, dt, par.gravity, u_hat_);
  add_pressure_gradient(domain_, next_.pressure, next_rho_, next_liquid_, -dt, u_hat_);
  CellVectors<Dim>& u_star = next_.u;
  u_star = u_hat_;
  if (mark_stress_elements(domain_, par.species, next_.phi, next_total_, diffusion_.elements)) {
    // The stress of the last step is the best guess of this one's.
    add_scaled(grid.layout(), grid.cells(), u_bar_, dt, state_.acceleration, u_star);
    report.diffusion = diffuse(domain_, next_rho_, u_hat_, dt, par.diffusion, diffusion_, u_star);
    if (!report.diffusion.converged) throw NumericalError("viscoplastic diffusion did not converge");
  }
  clock(Phase::diffusion);

  const double energy_star = kinetic_energy(grid, next_rho_, u_star);
  pressure_change_.fill(0);
  report.projection = solve_pressure(domain_, u_star, next_rho_, next_liquid_, no_pressure_, dt, par.linear,
                                     projection_, pressure_change_);
  add_pressure_gradient(domain_, pressure_change_, next_rho_, next_liquid_, -dt, next_.u);
  for_each<Node>(grid.layout(), grid.nodes(), [&](Node n) { next_.pressure[n] += pressure_change_[n]; });
  report.projection_energy_change = kinetic_energy(grid, next_rho_, next_.u) - energy_star;
  scaled_difference(grid.layout(), grid.cells(), 1 / dt, next_.u, u_bar_, next_.acceleration);
  require_finite(grid, next_);
  clock(Phase::projection);

  next_.time = state_.time + dt;
  next_.step = state_.step + 1;
  next_.dt = dt;
  std::swap(state_, next_);
  escaped_ = escaped;
  refresh();
  return report;
}

template class Flow<2>;
template class Flow<3>;

}  // namespace quicksand
