// Steady shear flows between walls: driven by a pressure difference, by a moving wall, by an inflow.
#include <gtest/gtest.h>

#include <cmath>

#include "support/figures.hpp"
#include "support/grids.hpp"
#include "support/viscometric.hpp"

namespace quicksand {
namespace {

const std::string exact_profile = "exact profile";

/// Sides, grid and law of a case with liquid everywhere.
CaseConfig full_case(const std::string& grid, const std::string& sides, const std::string& law,
                     const std::string& box) {
  return parse_case("title: a channel\nunits: none\ngrid: {" + grid + "}\nboundaries: {" + sides +
                        "}\ngravity: 0\nambient_pressure: 0\nspecies: [{name: mud, density: 1, rheology: " + law +
                        "}]\ninitial: [{fill: mud, shape: {box: {" + box + "}}}]\n" +
                        "time: {end: 30, cfl: 1.0, max_step: 0.1, until_steady: 1.0e-7}\n" +
                        "solver: {viscous_tolerance: 1.0e-9}\n",
                    "channel");
}

std::string axis(double from, double to, int cells) {
  return "{from: " + std::to_string(from) + ", to: " + std::to_string(to) + ", cells: " + std::to_string(cells) + "}";
}

/// Largest difference of a velocity component from its exact value.
template <int Dim, class Exact>
double largest_error(const Flow<Dim>& flow, int component, Exact&& exact) {
  const Grid<Dim>& grid = flow.domain().grid;
  return maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c, const Index<Dim>& i) {
    return std::abs(flow.state().u[component][c] - exact(grid.centre(i)));
  });
}

TEST(Channel, PressureDrivesAPlug) {
  const testing::StressLaw law = testing::papanastasiou_law(1, 0.5, 1000);
  double coarser = 0;
  for (const int n : {16, 32}) {
    CaseConfig config = testing::shipped_case("channel/poiseuille");
    config.grid.z.front().cells = n;
    const Flow<2> flow = testing::steady_flow<2>(config);
    const double error = largest_error(
        flow, 0, [&](const Vec<2>& x) { return testing::driven_velocity(law, 1, 1, 0.5, std::abs(x[1])); });
    const std::string plug = "channel, yield stress, " + std::to_string(n) + " cells";
    // In units of the plug's speed, 1/8.
    testing::expect_at_most({plug, "error of the velocity over the plug's", exact_profile}, 8 * error,
                            0.5 / (n * n / 256.0));
    if (coarser > 0) testing::expect_order({plug, "error of the velocity", exact_profile}, coarser, error, 1.9);
    coarser = error;
  }
}

TEST(Channel, PressureDrivesAParabolaOnAStretchedGrid) {
  const std::string grid =
      "dimension: 2, x: " + axis(0, 2, 4) + ", z: [{from: -1, to: -0.2, cells: 8}, {to: 1, cells: 8, stretch: smooth}]";
  const std::string sides =
      "x_min: {open: 2, outside: mud}, x_max: {open: 0, outside: mud}, z_min: no_slip, z_max: no_slip";
  const CaseConfig config = full_case(grid, sides, "{law: newtonian, viscosity: 1}", "from: [0, -1], to: [2, 1]");
  const Flow<2> flow = testing::steady_flow<2>(config);
  testing::expect_at_most({"channel, graded cells", "error of the velocity, largest 1/2", exact_profile},
                          largest_error(flow, 0, [](const Vec<2>& x) { return (1 - x[1] * x[1]) / 2; }), 3e-3);
}

TEST(Channel, AMovingWallDragsALinearProfile) {
  const std::string sides =
      "x_min: {open: 0, outside: mud}, x_max: {open: 0, outside: mud}, z_min: no_slip, z_max: {no_slip: [0.6, 0]}";
  for (const char* law : {"{law: newtonian, viscosity: 0.7}",
                          "{law: papanastasiou, viscosity: 0.7, yield_stress: 0.3, regularization: 20}"}) {
    const CaseConfig config = full_case("dimension: 2, x: " + axis(0, 1, 4) + ", z: " + axis(0, 1, 8), sides, law,
                                        "from: [0, 0], to: [1, 1]");
    const Flow<2> flow = testing::steady_flow<2>(config);
    testing::expect_at_most({std::string("moving wall, ") + law, "error of the velocity, wall 0.6", exact_profile},
                            largest_error(flow, 0, [](const Vec<2>& x) { return 0.6 * x[1]; }), 1e-6);
  }
}

TEST(Channel, ASlidingTubeDragsALogarithmicProfile) {
  double coarser = 0;
  for (const int n : {32, 64}) {
    const CaseConfig config =
        full_case("dimension: 2, geometry: axisymmetric, x: " + axis(1, 2, n) + ", z: " + axis(0, 1, 4),
                  "x_min: {no_slip: [0, 1]}, x_max: no_slip, z_min: {open: 0, outside: mud}, z_max: {open: 0, outside: "
                  "mud}",
                  "{law: newtonian, viscosity: 1}", "from: [1, 0], to: [2, 1]");
    const Flow<2> flow = testing::steady_flow<2>(config);
    const double error = largest_error(flow, 1, [](const Vec<2>& x) { return 1 - std::log(x[0]) / std::log(2.0); });
    const std::string tube = "sliding tube, " + std::to_string(n) + " cells";
    testing::expect_at_most({tube, "error of the velocity, wall 1", exact_profile}, error, 2e-3 / (n * n / 64.0));
    if (coarser > 0) testing::expect_order({tube, "error of the velocity", exact_profile}, coarser, error, 1.9);
    coarser = error;
  }
}

TEST(Channel, WallsMoveInSpace) {
  // Between walls across y, one of which slides obliquely.
  const CaseConfig config = full_case(
      "dimension: 3, x: " + axis(0, 1, 2) + ", y: " + axis(0, 1, 6) + ", z: " + axis(0, 1, 2),
      "x_min: {open: 0, outside: mud}, x_max: {open: 0, outside: mud}, y_min: no_slip, y_max: {no_slip: [0.6, "
      "0, 0]}, z_min: free_slip, z_max: free_slip",
      "{law: newtonian, viscosity: 1}", "from: [0, 0, 0], to: [1, 1, 1]");
  const Flow<3> flow = testing::steady_flow<3>(config);
  EXPECT_LE(largest_error(flow, 0, [](const Vec<3>& x) { return 0.6 * x[1]; }), 1e-6);
}

/// A channel that liquid enters with a profile of mean velocity 1.
CaseConfig fed_channel(const std::string& inflow) {
  return full_case("dimension: 2, x: " + axis(0, 6, 24) + ", z: " + axis(-1, 1, 16),
                   "x_min: {inflow: {" + inflow +
                       ", fill: mud}}, x_max: {open: 0, outside: mud}, z_min: no_slip, z_max: "
                       "no_slip",
                   "{law: newtonian, viscosity: 1}", "from: [0, -1], to: [6, 1]");
}

TEST(Channel, ADevelopedInflowStaysAsItIs) {
  const Flow<2> flow = testing::steady_flow<2>(fed_channel("velocity: [1.5, 0], profile: parabolic"));
  testing::expect_at_most({"channel, parabolic inflow", "error of the velocity, largest 1.5", exact_profile},
                          largest_error(flow, 0, [](const Vec<2>& x) { return 1.5 * (1 - x[1] * x[1]); }), 1e-5);
  EXPECT_LE(largest_error(flow, 1, [](const Vec<2>&) { return 0.0; }), 1e-5);
}

TEST(Channel, AUniformInflowDevelops) {
  const Flow<2> flow = testing::steady_flow<2>(fed_channel("velocity: [1, 0]"));
  const Grid<2>& grid = flow.domain().grid;
  for (int i = 0; i < 24; ++i) {
    double mean = 0;
    for (int j = 0; j < 16; ++j) mean += flow.state().u[0][grid.cell({i, j})] / 16;
    EXPECT_NEAR(mean, 1, 1e-6) << i;
  }
  // The discrete parabola of mean 1 has its largest cell value at 1.5 less 1.5 z^2 there, times 1 / (1 - h^2 / 8).
  const double h = 2.0 / 16;
  EXPECT_NEAR(flow.state().u[0][grid.cell({23, 8})], 1.5 * (1 - h * h / 4) / (1 + h * h / 8), 1e-3);
  // As much has left as has come in.
  EXPECT_NEAR(flow.escaped()[0], 0, 1e-6);
}

TEST(Channel, AJetFillsATank) {
  const CaseConfig config = parse_case(
      "title: a tank is filled\nunits: none\ngrid: {dimension: 2, x: " + axis(0, 1, 16) + ", z: " + axis(0, 1, 16) +
          "}\nboundaries: {x_min: {inflow: {velocity: [0.5, 0], fill: water}}, x_max: free_slip, z_min: free_slip, " +
          "z_max: {open: 1}}\ngravity: 1\nambient_pressure: 1\n" +
          "species: [{name: water, density: 1, rheology: {law: inviscid}}]\n" +
          "initial: [{fill: water, shape: {box: {from: [0, 0], to: [1, 0.25]}}}]\n" +
          "time: {end: 0.5, cfl: 0.4, max_step: 0.02}\n",
      "tank");
  Flow<2> flow = build_flow<2>(config);
  EXPECT_LE(0.5 * stable_step(flow, 0.4), 0.4 / 16);  // from rest the inflow bounds the step
  testing::run(config, flow);
  EXPECT_NEAR(species_volume(flow.domain().grid, flow.state().phi[0]), 0.25 + 0.5 * 0.5, 1e-9);
  EXPECT_NEAR(flow.escaped()[0], -0.25, 1e-9);
}

}  // namespace
}  // namespace quicksand
