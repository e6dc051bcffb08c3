// A disc of liquid flies through the void: nothing acts on it, so that it should keep shape, size and velocity.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/cases.hpp"
#include "support/figures.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

using testing::shipped_case;

const Vec<2> velocity{1, 0.5};
constexpr double radius = 0.15;
constexpr double start = 0.25;  ///< of both coordinates of the centre
constexpr double duration = 0.5;

CaseConfig flying_disc(int n, double courant) {
  const std::string text = R"(
title: A disc that flies through the void
units: none
grid: {dimension: 2, geometry: planar, x: {from: 0, to: 1, cells: N}, z: {from: 0, to: 1, cells: N}}
boundaries: {x_min: {open: 0.0}, x_max: {open: 0.0}, z_min: {open: 0.0}, z_max: {open: 0.0}}
gravity: 0
ambient_pressure: 0
species: [{name: liquid, density: 1, rheology: {law: inviscid}}]
initial: [{fill: liquid, shape: {sphere: {center: [0.25, 0, 0.25], radius: 0.15}}, velocity: [1, 0, 0.5]}]
time: {end: 0.5, step: 1}
)";
  const std::string step = "time.step=" + std::to_string(courant / n);
  std::string filled = text;
  for (std::size_t at = filled.find('N'); at != std::string::npos; at = filled.find('N')) {
    filled.replace(at, 1, std::to_string(n));
  }
  return parse_case(filled, "flying disc", {step});
}

struct Flight {
  double shape_error;     ///< volume in the wrong place over the disc's volume
  double velocity_error;  ///< largest, in cells of liquid
  double volume_error;    ///< relative
};

Flight fly(int n, double courant) {
  const CaseConfig config = flying_disc(n, courant);
  Flow<2> flow = build_flow<2>(config);
  const Grid<2>& grid = flow.domain().grid;
  const double volume = testing::integral(grid, flow.total());
  testing::run(config, flow);
  const Shape exact = SphereShape{{start + duration * velocity[0], 0, start + duration * velocity[1]}, radius};
  CellField wrong(grid.layout());
  Flight flight{};
  for_each<Cell>(grid.layout(), grid.cells(),
                 [&](Cell c, const Index<2>& i) { wrong[c] = std::abs(flow.total()[c] - fraction(exact, grid, i)); });
  for (int d = 0; d < 2; ++d) {
    flight.velocity_error = maximum<Cell>(grid.layout(), grid.cells(), flight.velocity_error, [&](Cell c) {
      return flow.total()[c] < empty_fraction ? 0.0 : std::abs(flow.state().u[d][c] - velocity[d]);
    });
  }
  flight.shape_error = 0.5 * testing::integral(grid, wrong) / volume;
  flight.volume_error = std::abs(testing::integral(grid, flow.total()) + flow.escaped()[0] - volume) / volume;
  return flight;
}

TEST(TransportConvergence, AFlyingDiscKeepsItsShape) {
  const Flight coarse = fly(32, 0.4);
  const Flight fine = fly(64, 0.4);
  const std::string misplaced = "part of the volume in the wrong place";
  testing::expect_at_most({"flying disc, 4.8 cells per radius", misplaced, "exact motion"}, coarse.shape_error, 0.025);
  testing::expect_at_most({"flying disc, 9.6 cells per radius", misplaced, "exact motion"}, fine.shape_error, 0.02);
  EXPECT_LT(fine.shape_error, coarse.shape_error);
}

TEST(TransportConvergence, AFlyingDiscKeepsItsVolumeAndVelocity) {
  const Flight flight = fly(32, 0.4);
  testing::expect_at_most({"flying disc, 4.8 cells per radius", "relative error of the volume", "kept"},
                          flight.volume_error, 1e-13);
  testing::expect_at_most({"flying disc, 4.8 cells per radius", "error of the velocity", "kept"}, flight.velocity_error,
                          1e-9);
}

}  // namespace
}  // namespace quicksand
