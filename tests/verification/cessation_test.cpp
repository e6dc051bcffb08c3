// Cessation of plane Poiseuille flow: the pressure gradient of a steady flow is taken away, and a liquid with a yield
// stress stops in finite time. With density, viscosity, half-width and mean speed 1 that is at t = 0.454 for a yield
// stress Bn = 1 and 0.290 for Bn = 2 (after Chatzimina, Georgiou, Argyropaidas, Mitsoulis and Huilgol 2005), from the
// steady profile of the same liquid. From the Newtonian parabola it takes a per cent longer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/diffusion.hpp"
#include "support/figures.hpp"
#include "support/mixtures.hpp"
#include "support/viscometric.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

/// Pressure gradient of the steady flow with mean speed 1: G/3 (1 - 3/2 X + 1/2 X^3) = 1, X = Bn/G.
double pressure_gradient(double bingham_number) {
  double low = bingham_number;
  double high = 100;
  for (int k = 0; k < 100; ++k) {
    const double G = 0.5 * (low + high);
    const double X = bingham_number / G;
    (G / 3 * (1 - 1.5 * X + 0.5 * X * X * X) < 1 ? low : high) = G;
  }
  return low;
}

/// Time at which the largest speed falls to 1e-6.
double stopping_time(double bingham_number, int cells, double dt) {
  const Grid<2> grid({testing::uniform_axis(2, 0, 0.1), testing::uniform_axis(cells, -1, 1)}, Geometry::planar);
  Sides<2> sides = testing::all_sides(grid, SideKind::no_slip);
  sides.at(0, 0).kind = sides.at(0, 1).kind = SideKind::open;
  const Domain<2> domain(grid, sides);
  const Mixture<2> mixture = testing::full(domain, testing::liquid_species(1, Bingham{1, bingham_number}));
  DiffusionWork<2> work(domain, mixture.species);
  mark_stress_elements(domain, mixture.species, mixture.phi, mixture.total, work.elements);
  const double G = pressure_gradient(bingham_number);
  const double plug = bingham_number / G;
  CellVectors<2> u(domain.layout());
  testing::set_cells(domain.grid, u[0], [&](const Vec<2>& x) {
    const double y = std::max(std::abs(x[1]), plug);
    return 0.5 * G * (1 - y * y) - bingham_number * (1 - y);
  });
  for (int step = 1; step * dt < 1; ++step) {
    const CellVectors<2> u_hat = u;
    EXPECT_TRUE(diffuse(domain, mixture.rho, u_hat, dt, {}, work, u).converged);
    const double fastest =
        maximum<Cell>(domain.layout(), domain.grid.cells(), 0.0, [&](Cell c) { return std::abs(u[0][c]); });
    if (fastest < 1e-6) return step * dt;
  }
  return 1;
}

TEST(Cessation, ChannelFlowStopsInFiniteTime) {
  const std::string source = "Chatzimina et al. 2005";
  testing::expect_relative({"channel, Bn = 1, 40 cells", "time at which it stops", source}, stopping_time(1, 40, 1e-3),
                           0.454, 0.01);
  testing::expect_relative({"channel, Bn = 2, 40 cells", "time at which it stops", source}, stopping_time(2, 40, 1e-3),
                           0.290, 0.01);
}

TEST(Cessation, WholeFlowStopsAndStaysAtRest) {
  for (const auto& [bingham_number, stops] : {std::pair{1.0, 0.454}, std::pair{2.0, 0.290}}) {
    CaseConfig config = testing::shipped_case("channel/couette");
    config.grid.x.front().cells = 2;
    config.grid.z = {{-1, 1, 64, Stretch::uniform}};
    config.initial.front().shape = LayerShape{-1, 1};
    config.boundaries.z_max->velocity = {};
    config.species.front().law = Bingham{1, bingham_number};
    config.gravity = {{pressure_gradient(bingham_number), 0, 0}};
    const Flow<2> driven = testing::steady_flow<2>(config);
    config.gravity = {};
    Flow<2> flow = build_flow<2>(config);
    flow.state().u = driven.state().u;
    flow.initialize();
    while (diagnose(flow).max_speed > 1e-6 && flow.state().time < 1) flow.advance(1e-3);
    EXPECT_NEAR(flow.state().time, stops, 0.03 * stops) << bingham_number;
    for (int k = 0; k < 3; ++k) flow.advance(1e-3);
    EXPECT_LE(diagnose(flow).max_speed, 1e-9) << bingham_number;
  }
}

}  // namespace
}  // namespace quicksand
