#include "physics/step_guard.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/errors.hpp"
#include "core/text_output.hpp"
#include "physics/energy.hpp"

namespace quicksand {

namespace {

/// Part of a cell's width within which a step may move liquid by round-off.
constexpr double negligible_way = 1e-10;

template <int Dim>
double whole_mass(const Grid<Dim>& grid, const CellField& rho) {
  return sum<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) { return rho[c] * grid.volume(i); });
}

void check_rise(const char* phase, double rise, double scale, double bound) {
  if (!(rise > bound * scale)) return;
  throw NumericalError(std::string(phase) + " raised the kinetic energy by " + number_text(rise / scale) +
                       " of the largest so far, more than guard.energy_rise " + number_text(bound));
}

}  // namespace

void check_balance(const StepBalance& balance, const std::vector<Species>& species, const GuardSettings& guard) {
  // What has come in through a side counts as escaped, less than nothing: then the start says little.
  const double start = std::accumulate(balance.volume_before.begin(), balance.volume_before.end(), 0.0);
  const double whole = std::max(start, balance.liquid);
  for (std::size_t i = 0; i < species.size(); ++i) {
    const double error = std::abs(balance.volume_after[i] - balance.volume_before[i]);
    if (error <= guard.volume_error * whole) continue;
    throw NumericalError("the volume of " + species[i].name + " changed by " + number_text(error / whole) +
                         " of all liquid, more than guard.volume_error " + number_text(guard.volume_error));
  }
  check_rise("redistribution", balance.redistribution_rise, balance.energy_scale, guard.energy_rise);
  check_rise("projection", balance.projection_rise, balance.energy_scale, guard.energy_rise);
}

template <int Dim>
void require_finite(const Grid<Dim>& grid, const State<Dim>& state) {
  double checksum = sum<Cell>(grid.layout(), grid.cells(), [&](Cell c) {
    double total = 0;
    for (const CellField& phi_i : state.phi) total += phi_i[c];
    for (int d = 0; d < Dim; ++d) total += state.u[d][c];
    return total;
  });
  checksum += sum<Node>(grid.layout(), grid.nodes(), [&](Node n) { return state.pressure[n]; });
  for (const Bubble& b : state.gas.bubbles) checksum += b.pressure + b.volume;
  if (!std::isfinite(checksum)) throw NumericalError("the flow has values that are not finite");
}

template <int Dim>
std::vector<double> volumes(const Grid<Dim>& grid, const Fractions& phi, const std::vector<double>& escaped) {
  std::vector<double> volume = escaped;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    volume[i] += sum<Cell>(grid.layout(), grid.cells(),
                           [&](Cell c, const Index<Dim>& at) { return phi[i][c] * grid.volume(at); });
  }
  return volume;
}

template <int Dim>
double energy_at_stake(const Grid<Dim>& grid, const CellField& rho, const State<Dim>& state, const Vec<Dim>& gravity) {
  const double mass = whole_mass(grid, rho);
  double energy = kinetic_energy(grid, rho, state.u);
  for (const Bubble& b : state.gas.bubbles) energy += b.pressure * b.volume / (b.exponent - 1);
  for (int d = 0; d < Dim; ++d) {
    const std::vector<double>& faces = grid.global_faces(d);
    energy += mass * std::abs(gravity[d]) * (faces.back() - faces.front());
  }
  return energy;
}

template <int Dim>
double negligible_energy(const Grid<Dim>& grid, const CellField& rho, double dt) {
  const double speed = negligible_way * grid.smallest_width() / dt;
  return 0.5 * whole_mass(grid, rho) * speed * speed;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                         \
  template void require_finite(const Grid<Dim>&, const State<Dim>&);                                       \
  template std::vector<double> volumes(const Grid<Dim>&, const Fractions&, const std::vector<double>&);    \
  template double energy_at_stake(const Grid<Dim>&, const CellField&, const State<Dim>&, const Vec<Dim>&); \
  template double negligible_energy(const Grid<Dim>&, const CellField&, double);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
