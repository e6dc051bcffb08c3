// Flows moved from grid to grid: what is conserved, what may not rise, and the order of what is lost on the way.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/case_config.hpp"
#include "core/errors.hpp"
#include "physics/diagnostics.hpp"
#include "physics/energy.hpp"
#include "physics/remap.hpp"
#include "support/cases.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

using testing::graded_axis;
using testing::uniform_axis;

/// Sand with a slope under water with a slope, a bubble in the sand, all moving.
template <int Dim>
Flow<Dim> bubbly_flow(Grid<Dim> grid) {
  FlowParameters<Dim> parameters;
  parameters.species = {{.name = "sand", .density = 2, .law = Inviscid{}, .concentration = {}},
                        {.name = "water", .density = 1, .law = Inviscid{}, .concentration = {}}};
  parameters.ambient_pressure = 1;
  Sides<Dim> sides = testing::all_sides(grid, SideKind::free_slip);
  sides.at(Dim - 1, 1) = {SideKind::open, 1.0, std::nullopt, {}, Profile::uniform};
  Flow<Dim> flow(Domain<Dim>(grid, sides), parameters);
  State<Dim>& state = flow.state();
  const int id = ++state.gas.last_id;
  state.gas.bubbles.push_back({.id = id, .exponent = 1.3, .pressure = 5});
  const double h = 1.0 / grid.owned_cells()[0];
  const auto below = [&](double height) { return std::clamp(height / h + 0.5, 0.0, 1.0); };
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    const Vec<Dim> x = grid.centre(i);
    Vec<Dim> middle;
    middle[Dim - 1] = 0.3;
    const double liquid = below(testing::distance(x, middle) - 0.17);
    const double water = below(0.8 + 0.1 * x[0] - x[Dim - 1]);
    const double sand = below(0.5 + 0.2 * x[0] - x[Dim - 1]);
    state.phi[0][c] = liquid * sand;
    state.phi[1][c] = liquid * (water - sand);
    if (liquid < 0.5) state.gas.region[c] = id;
    for (int d = 0; d < Dim; ++d) state.u[d][c] = water * liquid > 0 ? std::sin(3 * x[d] + x[0] + d) : 0.0;
  });
  flow.initialize();
  return flow;
}

template <int Dim>
double largest_speed(const Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  return maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) {
    double square = 0;
    for (int d = 0; d < Dim; ++d) square += flow.state().u[d][c] * flow.state().u[d][c];
    return std::sqrt(square);
  });
}

template <int Dim>
double momentum(const Flow<Dim>& flow, int d) {
  const Grid<Dim>& grid = flow.domain().grid;
  return sum<Cell>(grid.layout(), grid.cells(),
                   [&](Cell c) { return flow.density()[c] * grid.volume(c) * flow.state().u[d][c]; });
}

/// Moves the flow to another grid and checks all that holds of every remap.
template <int Dim>
Flow<Dim> checked_remap(const Flow<Dim>& flow, const Grid<Dim>& grid) {
  RemapReport report;
  Flow<Dim> moved = remap(flow, Domain<Dim>(grid, flow.domain().sides), report);
  const Grid<Dim>& from = flow.domain().grid;
  double whole = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double volume = species_volume(from, flow.state().phi[k]);
    EXPECT_NEAR(species_volume(grid, moved.state().phi[k]), volume, 1e-12 * volume) << "species " << k;
    whole += volume;
  }
  for (int d = 0; d < Dim; ++d) EXPECT_NEAR(momentum(moved, d), momentum(flow, d), 1e-12 * whole) << "axis " << d;
  const double fullest = maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) { return moved.total()[c]; });
  EXPECT_LE(fullest, 1 + 1e-12);
  for (const CellField& phi : moved.state().phi) {
    EXPECT_LE(maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) { return -phi[c]; }), 1e-12);
  }
  const double energy = kinetic_energy(from, flow.density(), flow.state().u);
  EXPECT_LE(kinetic_energy(grid, moved.density(), moved.state().u), energy * (1 + 1e-12));
  EXPECT_LE(largest_speed(moved), largest_speed(flow) * (1 + 1e-12));
  EXPECT_EQ(report.kinetic_energy_before, energy);
  return moved;
}

template <int Dim>
void expect_same_gas(const Flow<Dim>& before, const Flow<Dim>& after, double volume_change) {
  ASSERT_EQ(after.state().gas.bubbles.size(), 1u);
  const Bubble& old = before.state().gas.bubbles[0];
  const Bubble& now = after.state().gas.bubbles[0];
  EXPECT_EQ(now.id, old.id);
  EXPECT_NEAR(now.amount, old.amount, 1e-14 * old.amount);
  EXPECT_NEAR(now.volume, old.volume, volume_change * old.volume);
  EXPECT_NEAR(now.pressure * std::pow(now.volume, now.exponent), old.pressure * std::pow(old.volume, old.exponent),
              1e-12 * old.constant);
}

TEST(Remap, ConservesAndNeverGainsInThePlane) {
  const Flow<2> coarse = bubbly_flow(testing::planar_grid(24));
  const Flow<2> fine = checked_remap(coarse, testing::stretched_grid(53));
  const Flow<2> back = checked_remap(fine, testing::planar_grid(24));
  expect_same_gas(coarse, fine, 0.01);
  expect_same_gas(fine, back, 0.01);
}

TEST(Remap, ConservesAndNeverGainsAroundAnAxis) {
  const Flow<2> coarse = bubbly_flow(testing::tank_grid(24));
  const Grid<2> other({graded_axis(37, 0, 1, 3), graded_axis(31, 0, 1, 2)}, Geometry::axisymmetric);
  const Flow<2> fine = checked_remap(coarse, other);
  const Flow<2> back = checked_remap(fine, testing::tank_grid(20));
  expect_same_gas(coarse, fine, 0.01);
  expect_same_gas(fine, back, 0.01);
}

TEST(Remap, ConservesAndNeverGainsInSpace) {
  const Flow<3> coarse = bubbly_flow(testing::box_grid(14));
  const Grid<3> other({graded_axis(17, 0, 1, 2), uniform_axis(11), graded_axis(19, 0, 1, 0.5)}, Geometry::cartesian);
  const Flow<3> fine = checked_remap(coarse, other);
  expect_same_gas(coarse, fine, 0.02);
}

TEST(Remap, SameGridGivesTheSameFlow) {
  for (const Grid<2>& grid : {testing::stretched_grid(20), testing::tank_grid(20)}) {
    const Flow<2> flow = bubbly_flow(grid);
    const Flow<2> same = checked_remap(flow, grid);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_LE(testing::largest_difference(grid, flow.state().phi[k], same.state().phi[k]), 1e-13);
    }
    for (int d = 0; d < 2; ++d) {
      EXPECT_LE(testing::largest_difference(grid, flow.state().u[d], same.state().u[d]), 1e-13);
      EXPECT_LE(testing::largest_difference(grid, flow.state().acceleration[d], same.state().acceleration[d]), 1e-12);
    }
    EXPECT_NEAR(flow.state().gas.bubbles[0].pressure, same.state().gas.bubbles[0].pressure, 1e-12);
  }
}

TEST(Remap, LevelSurfacesStayLevelInsideFinerCells) {
  // Water up to the middle of a row of wide cells: finer cells are full below and empty above, and not all half full.
  Flow<2> coarse = bubbly_flow(testing::planar_grid(10));
  coarse.state().gas = GasState(coarse.domain().layout());
  testing::set_cells(coarse.domain().grid, coarse.state().phi[0], [](const Vec<2>&) { return 0.0; });
  testing::set_cells(coarse.domain().grid, coarse.state().phi[1],
                     [](const Vec<2>& x) { return std::clamp((0.55 - x[1]) / 0.1 + 0.5, 0.0, 1.0); });
  coarse.initialize();
  const Grid<2> fine_grid({uniform_axis(10), uniform_axis(40)}, Geometry::planar);
  const Flow<2> fine = checked_remap(coarse, fine_grid);
  CellField expected(fine_grid.layout());
  testing::set_cells(fine_grid, expected, [](const Vec<2>& x) { return x[1] < 0.55 ? 1.0 : 0.0; });
  EXPECT_LE(testing::largest_difference(fine_grid, fine.state().phi[1], expected), 1e-12);
}

/// A closed box full of liquid with a smooth velocity.
Flow<2> smooth_flow(const Grid<2>& grid) {
  FlowParameters<2> parameters;
  parameters.species = {{.name = "water", .density = 1, .law = Inviscid{}, .concentration = {}}};
  Flow<2> flow(testing::make_domain(grid, SideKind::free_slip), parameters);
  constexpr double pi = std::numbers::pi;
  testing::set_cells(grid, flow.state().phi[0], [](const Vec<2>&) { return 1.0; });
  testing::set_cells(grid, flow.state().u[0],
                     [](const Vec<2>& x) { return std::sin(pi * x[0]) * std::cos(pi * x[1]); });
  testing::set_cells(grid, flow.state().u[1],
                     [](const Vec<2>& x) { return -std::cos(pi * x[0]) * std::sin(pi * x[1]); });
  flow.initialize();
  return flow;
}

/// Mean change of a smooth velocity after eight moves to and fro between n cells and a stretched grid of n * ratio.
double to_and_fro(int n, double ratio) {
  const Grid<2> one = testing::planar_grid(n);
  const int m = static_cast<int>(n * ratio);
  const Grid<2> other({graded_axis(m, 0, 1, 2), graded_axis(m, 0, 1, 0.5)}, Geometry::planar);
  const Flow<2> start = smooth_flow(one);
  Flow<2> flow = start;
  RemapReport report;
  for (int k = 0; k < 4; ++k) {
    Flow<2> there = remap(flow, Domain<2>(other, start.domain().sides), report);
    flow = remap(there, Domain<2>(one, start.domain().sides), report);
  }
  return sum<Cell>(one.layout(), one.cells(), [&](Cell c) {
    return one.volume(c) *
           std::hypot(flow.state().u[0][c] - start.state().u[0][c], flow.state().u[1][c] - start.state().u[1][c]);
  });
}

TEST(Remap, ToAndFroIsOfSecondOrder) {
  for (const double ratio : {0.7, 1.6}) {
    const double coarse = to_and_fro(20, ratio);
    const double fine = to_and_fro(40, ratio);
    const double finer = to_and_fro(80, ratio);
    EXPECT_GT(std::log2(coarse / fine), 1.7) << "ratio " << ratio << ", errors " << coarse << " " << fine;
    EXPECT_GT(std::log2(fine / finer), 1.8) << "ratio " << ratio << ", errors " << fine << " " << finer;
  }
}

TEST(Remap, OtherDomainsAreRefused) {
  const Flow<2> flow = bubbly_flow(testing::planar_grid(8));
  RemapReport report;
  const Grid<2> wider({uniform_axis(8, 0, 2), uniform_axis(8)}, Geometry::planar);
  EXPECT_THROW(remap(flow, Domain<2>(wider, flow.domain().sides), report), InputError);
  EXPECT_THROW(remap(flow, Domain<2>(testing::tank_grid(8), flow.domain().sides), report), InputError);
}

TEST(Remap, FlowGoesOnWithoutSpray) {
  // A slug that collapses, moved to finer cells in the middle: no step after it is faster than the undisturbed run's.
  CaseConfig config = testing::with_cfl(testing::shipped_case("slug/case_e", {"time.end=0.4"}));
  Flow<2> flow = build_flow<2>(config);
  testing::run(config, flow);
  RemapReport report;
  Flow<2> moved = remap(flow, Domain<2>(make_grid<2>(testing::refined(config, 2).grid), flow.domain().sides), report);
  const double speed = largest_speed(flow);
  for (int k = 0; k < 10; ++k) {
    flow.advance(0.005);
    moved.advance(0.0025);
    moved.advance(0.0025);
    EXPECT_LE(largest_speed(moved), 1.05 * std::max(speed, largest_speed(flow))) << "step " << k;
  }
  const double energy = kinetic_energy(flow.domain().grid, flow.density(), flow.state().u);
  EXPECT_NEAR(kinetic_energy(moved.domain().grid, moved.density(), moved.state().u), energy, 0.02 * energy);
}

}  // namespace
}  // namespace quicksand
