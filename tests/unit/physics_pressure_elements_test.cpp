// The nodal pressure where a surface or an interface lies inside cells.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/energy.hpp"
#include "physics/projection.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

const SolveOptions sharp{{.relative = 1e-13, .max_iterations = 500}, Method::automatic};

/// Accelerations of a mixture under gravity, from rest, with the gas at a pressure.
template <int Dim>
CellVectors<Dim> accelerate(const Mixture<Dim>& mixture, const Vec<Dim>& gravity, double gas_pressure) {
  const Domain<Dim>& domain = mixture.domain;
  CellVectors<Dim> u(domain.layout());
  for (int d = 0; d < Dim; ++d) u[d].fill(gravity[d]);
  ProjectionWork<Dim> work(domain.layout());
  NodeField pressure(domain.layout(), gas_pressure);
  solve_pressure(domain, Projected::acceleration, 0.0, u, mixture.rho, mixture.elements, 1, sharp, work, pressure);
  add_pressure_gradient(domain, pressure, mixture.rho, mixture.elements, -1, u);
  return u;
}

/// Part of a cell below the height z.
template <int Dim>
double filled_below(const Grid<Dim>& grid, const Index<Dim>& i, double z) {
  constexpr int up = Dim - 1;
  return std::clamp((z - grid.face_position(up, i[up])) / grid.width_1d(up, i[up]), 0.0, 1.0);
}

/// Two layers, densities 2 and 1, up to `interface` and `surface`, stay at rest wherever these lie.
template <int Dim>
void expect_rest(const Domain<Dim>& domain, double interface, double surface) {
  const Grid<Dim>& grid = domain.grid;
  Mixture<Dim> mixture(domain, {testing::liquid_species(2), testing::liquid_species(1)});
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    mixture.phi[0][c] = filled_below(grid, i, interface);
    mixture.phi[1][c] = filled_below(grid, i, surface) - mixture.phi[0][c];
  });
  mixture.update();
  Vec<Dim> gravity;
  gravity[Dim - 1] = -3;
  const CellVectors<Dim> a = accelerate(mixture, gravity, 0.7);
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c) {
    if (mixture.total[c] < pressureless_fraction) return;
    for (int d = 0; d < Dim; ++d) EXPECT_NEAR(a[d][c], 0, 1e-9) << surface;
  });
}

TEST(PhysicsPressureElements, LayersAreAtRestWhereverTheirSurfacesLie) {
  const auto plane = testing::make_domain(testing::planar_grid(8), SideKind::no_slip);
  const auto tank = testing::make_domain(testing::tank_grid(8), SideKind::no_slip);
  const auto box = testing::make_domain(testing::box_grid(6), SideKind::no_slip);
  for (const double shift : {0.002, 0.02, 0.05, 0.1}) {
    expect_rest(plane, 0.25 + shift, 0.6 + shift);
    expect_rest(tank, 0.25 + shift, 0.6 + shift);
    expect_rest(box, 0.25 + shift, 0.6 + shift);
  }
}

TEST(PhysicsPressureElements, SlopesOfASurfacePushWithTheExactForce) {
  // With the slope s of a shallow layer of depth f h in the lowest row, g s drives it sideways, whatever f.
  const auto domain = testing::make_domain(testing::planar_grid(16), SideKind::free_slip);
  const Grid<2>& grid = domain.grid;
  for (const double filling : {0.3, 0.5, 0.8}) {
    constexpr double slope = 1e-4;
    Mixture<2> mixture(domain, {testing::liquid_species(1.3)});
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<2>& i) {
      const double height = filling * grid.width_1d(1, 0) + slope * (grid.centre(i)[0] - 0.5);
      mixture.phi[0][c] = filled_below(grid, i, height);
    });
    mixture.update();
    // Hydrostatic pressure on the floor; on all other nodes that of the gas.
    NodeField pressure(domain.layout());
    for_each<Node>(domain.layout(), grid.nodes(), [&](Node n, const Index<2>& i) {
      if (i[1] == 0) {
        pressure[n] = 1.3 * 3 * (filling * grid.width_1d(1, 0) + slope * (grid.face_position(0, i[0]) - 0.5));
      }
    });
    CellVectors<2> a(domain.layout());
    add_pressure_gradient(domain, pressure, mixture.rho, mixture.elements, -1, a);
    for (int i = 2; i < 14; ++i) EXPECT_NEAR(a[0][grid.cell({{i, 0}})] / (-3 * slope), 1, 1e-6) << filling;
  }
}

template <int Dim>
void expect_no_force_on_the_whole(const Mixture<Dim>& mixture) {
  // What one cell gives its neighbour takes: pressures inside a body that touches nothing change no momentum.
  const Domain<Dim>& domain = mixture.domain;
  const Grid<Dim>& grid = domain.grid;
  NodeField pressure(domain.layout());
  for_each<Node>(domain.layout(), grid.nodes(), [&](Node n, const Index<Dim>& i) {
    pressure[n] = mixture.elements.free[n] ? testing::rough(i, 1) : 0.0;
  });
  CellVectors<Dim> a(domain.layout());
  add_pressure_gradient(domain, pressure, mixture.rho, mixture.elements, -1, a);
  for (int d = 0; d < Dim; ++d) {
    const double force =
        sum<Cell>(domain.layout(), grid.cells(), [&](Cell c) { return mixture.rho[c] * grid.volume(c) * a[d][c]; });
    EXPECT_NEAR(force, 0, 1e-13);
  }
}

TEST(PhysicsPressureElements, PressuresInsideABodyConserveItsMomentum) {
  const auto plane = testing::make_domain(testing::stretched_grid(20), SideKind::no_slip);
  const auto box = testing::make_domain(testing::box_grid(10), SideKind::no_slip);
  expect_no_force_on_the_whole(testing::ball<2>(plane, testing::liquid_species(1.7), {0.5, 0.5}, 0.3));
  expect_no_force_on_the_whole(testing::ball<3>(box, testing::liquid_species(1.7), {0.5, 0.5, 0.5}, 0.3));
}

TEST(PhysicsPressureElements, FilmsAboveBearPressureAndGapsDoNot) {
  const auto domain = testing::make_domain(testing::planar_grid(8), SideKind::no_slip);
  const Grid<2>& grid = domain.grid;
  const auto bears = [&](double row_filling, bool liquid_above) {
    Mixture<2> mixture(domain, {testing::liquid_species(1)});
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<2>& i) {
      mixture.phi[0][c] = i[1] < 3 || (i[1] > 3 && liquid_above) ? 1 : i[1] == 3 ? row_filling : 0;
    });
    mixture.update();
    return mixture.elements.bears[grid.cell({{4, 3}})] != 0;
  };
  EXPECT_TRUE(bears(0.01, false));
  EXPECT_FALSE(bears(0.5 * pressureless_fraction, false));
  EXPECT_FALSE(bears(0.9 * gap_fraction, true));
  EXPECT_TRUE(bears(1.1 * gap_fraction, true));
}

}  // namespace
}  // namespace quicksand
