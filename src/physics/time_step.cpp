#include "physics/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/diagnostics.hpp"

namespace quicksand {

namespace {

/// Largest 1 / dt for which no bubble changes its volume by more than cfl / 2 of it, by its last rate of change, nor
/// passes more than cfl of a radian of its own oscillation, omega^2 = Dim gamma P / (rho R^2) with the radius R of a
/// ball of its volume.
template <int Dim>
double bubble_rate(const Flow<Dim>& flow, double cfl) {
  double rho = INFINITY;
  for (const Species& s : flow.parameters().species) rho = std::min(rho, s.density);
  const bool disc = flow.domain().grid.geometry() == Geometry::planar;
  const double circle = full_circle(flow.domain().grid);
  double rate = 0;
  for (const Bubble& b : flow.state().gas.bubbles) {
    const double volume = circle * b.volume;
    const double radius = disc ? std::sqrt(volume / std::numbers::pi) : std::cbrt(3 * volume / (4 * std::numbers::pi));
    const double omega = std::sqrt((disc ? 2 : 3) * b.exponent * std::max(b.pressure, 0.0) / rho) / radius;
    rate = std::max({rate, 2 * std::abs(b.growth) / b.volume / cfl, omega / cfl});
  }
  return rate;
}

/// 1 / dt for which what comes in through inflow sides moves cfl cell widths.
template <int Dim>
double inflow_rate(const Domain<Dim>& domain, double cfl) {
  double rate = 0;
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      const Side& side = domain.sides.at(d, s);
      if (side.kind != SideKind::inflow) continue;
      const double width = domain.grid.width_1d(d, s == 0 ? 0 : domain.grid.owned_cells()[d] - 1);
      rate = std::max(rate, std::abs(side.velocity[d]) / (cfl * width));
    }
  }
  return rate;
}

}  // namespace

template <int Dim>
double stable_step(const Flow<Dim>& flow, double cfl) {
  const Grid<Dim>& grid = flow.domain().grid;
  const State<Dim>& state = flow.state();
  double rate = std::max(bubble_rate(flow, cfl), inflow_rate(flow.domain(), cfl));  // largest 1 / dt
  for (int d = 0; d < Dim; ++d) {
    const double g = std::abs(flow.parameters().gravity[d]);
    rate = std::max(rate, maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c, const Index<Dim>& i) {
                      if (flow.total()[c] < empty_fraction) return 0.0;
                      const double v = std::abs(state.u[d][c]) / grid.width_1d(d, i[d]);
                      const double a = std::max(std::abs(state.acceleration[d][c]), g) / grid.width_1d(d, i[d]);
                      return (v + std::sqrt(v * v + 2 * a * cfl)) / (2 * cfl);
                    }));
  }
  return rate > 0 ? 1 / rate : INFINITY;
}

template double stable_step(const Flow<2>&, double);
template double stable_step(const Flow<3>&, double);

}  // namespace quicksand
