#include "physics/pressure_operator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/projection.hpp"
#include "support/grids.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

constexpr double dt = 0.1;

/// dt K x on free nodes, cell by cell.
template <int Dim>
NodeField product(const Mixture<Dim>& mixture, const NodeField& x) {
  const Domain<Dim>& domain = mixture.domain;
  const Corners<Dim> corners(domain.layout());
  NodeField y(domain.layout());
  for_each_coloured<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<Dim>& i) {
    if (!mixture.elements.bears[c]) return;
    const CellPressure<Dim> cell(domain.grid, corners, mixture.elements, c, i);
    for (int a = 0; a < Corners<Dim>::count; ++a) {
      const Node n = low_node(c) + corners.step[a];
      for (int b = 0; b < Corners<Dim>::count && mixture.elements.free[n]; ++b) {
        y[n] += dt / mixture.rho[c] * cell.stiffness[a][b] * x[low_node(c) + corners.step[b]];
      }
    }
  });
  return y;
}

template <int Dim>
void expect_products(const Mixture<Dim>& mixture) {
  const Layout<Dim>& layout = mixture.domain.layout();
  const Box<Dim> nodes = mixture.domain.grid.nodes();
  const auto free = [&](Node n) { return mixture.elements.free[n] != 0; };
  const Box<Dim> box = bounding_box<Node>(layout, nodes, free);
  NodeField x(layout);
  NodeField y(layout, 7.0);
  for_each<Node>(layout, nodes, [&](Node n, const Index<Dim>& i) { x[n] = free(n) ? testing::rough(i, 1) : 0.0; });
  const NodeField expected = product(mixture, x);
  const double largest = maximum<Node>(layout, nodes, 0.0, [&](Node n) { return std::abs(expected[n]); });
  ASSERT_GT(largest, 1e-4);
  PressureOperator<Dim>(mixture.domain, mixture.rho, mixture.elements, dt, box).apply(x, y);
  for_each<Node>(layout, box, [&](Node n) {
    if (free(n)) {
      EXPECT_NEAR(y[n], expected[n], 1e-13 * largest);
    } else {
      EXPECT_EQ(y[n], 0);
    }
  });
}

template <int Dim>
Mixture<Dim> layered_ball(const Domain<Dim>& domain, const Vec<Dim>& centre, double radius) {
  Mixture<Dim> mixture = testing::ball(domain, testing::liquid_species(2), centre, radius);
  mixture.species.push_back(testing::liquid_species(0.1));
  mixture.phi.push_back(mixture.phi[0]);
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<Dim>& i) {
    const bool heavy = domain.grid.centre(i)[Dim - 1] < centre[Dim - 1];
    mixture.phi[heavy ? 1 : 0][c] = 0;
  });
  mixture.update();
  return mixture;
}

TEST(PhysicsPressureOperator, IsTheSumOverTheCells) {
  const auto plane = testing::make_domain(testing::stretched_grid(20), SideKind::no_slip);
  const auto tank = testing::make_domain(testing::tank_grid(20), SideKind::open);
  const auto box = testing::make_domain(testing::box_grid(12), SideKind::free_slip);
  expect_products(layered_ball<2>(plane, {0.4, 0.5}, 0.3));
  expect_products(layered_ball<2>(tank, {0, 0.2}, 0.5));
  expect_products(layered_ball<3>(box, {0.4, 0.1, 0.5}, 0.4));
  expect_products(testing::full(box, testing::liquid_species(1.7)));
}

TEST(PhysicsPressureOperator, TakesRowsOfAnyLength) {
  const Grid<2> grid({testing::uniform_axis(300), testing::uniform_axis(8)}, Geometry::planar);
  const auto domain = testing::make_domain(Grid<2>(grid), SideKind::no_slip);
  expect_products(layered_ball<2>(domain, {0.5, 0.5}, 0.49));
}

/// Pressure of a mixture in rough motion, between gas of two pressures, and the work of these.
struct Projection {
  NodeField pressure;
  double work;
};

/// The box is too large for factors.
Projection project(const Mixture<3>& mixture, double memory, Method method) {
  const Domain<3>& domain = mixture.domain;
  const CellVectors<3> u = testing::rough_vectors(domain.grid, 4);
  ProjectionWork<3> work(domain.layout());
  NodeField pressure(domain.layout());
  for_each<Node>(domain.layout(), domain.grid.nodes(),
                 [&](Node n, const Index<3>& i) { pressure[n] = i[0] < 10 ? 3.0 : 4.0; });
  const SolveOptions sharp{{.relative = 1e-12, .max_iterations = 500}, method};
  const SolveReport report =
      solve_pressure(domain, Projected::velocity, memory, u, mixture.rho, mixture.elements, dt, sharp, work, pressure);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.method, name(Method::star_pfmg));
  return {pressure, gas_work(domain, u, mixture.rho, mixture.elements, dt, work)};
}

TEST(PhysicsPressureOperator, GivesThePressureOfTheMatrix) {
  for (const SideKind kind : {SideKind::free_slip, SideKind::open}) {
    const auto domain = testing::make_domain(testing::box_grid(20), kind);
    for (const bool whole : {true, false}) {
      const Mixture<3> mixture =
          whole ? testing::full(domain, testing::liquid_species(1.7)) : layered_ball<3>(domain, {0.5, 0.5, 0.5}, 0.45);
      for (const double memory : {0.0, 1.0}) {
        const Projection by_operator = project(mixture, memory, Method::automatic);
        const Projection by_matrix = project(mixture, memory, Method::star_pfmg);
        const double largest = maximum<Node>(domain.layout(), domain.grid.nodes(), 0.0,
                                             [&](Node n) { return std::abs(by_matrix.pressure[n] - 3); });
        ASSERT_GT(largest, 0.01);
        for_each<Node>(domain.layout(), domain.grid.nodes(),
                       [&](Node n) { EXPECT_NEAR(by_operator.pressure[n], by_matrix.pressure[n], 1e-8 * largest); });
        EXPECT_NEAR(by_operator.work, by_matrix.work, 1e-8 * std::abs(by_matrix.work));
        EXPECT_EQ(by_matrix.work != 0, !whole || kind == SideKind::open);
      }
    }
  }
}

TEST(PhysicsPressureOperator, FallsBackToTheMatrix) {
  const auto domain = testing::make_domain(testing::box_grid(20), SideKind::free_slip);
  const Mixture<3> mixture = layered_ball<3>(domain, {0.5, 0.5, 0.5}, 0.45);
  const CellVectors<3> u = testing::rough_vectors(domain.grid, 4);
  NodeField pressure[2];
  for (const bool falls : {false, true}) {
    ProjectionWork<3> work(domain.layout());
    pressure[falls] = NodeField(domain.layout(), 3.0);
    // Plane relaxation gets there in as many iterations, points do not.
    const SolveOptions sharp{{.relative = 1e-9, .max_iterations = falls ? 15 : 500}, Method::automatic};
    const SolveReport report = solve_pressure(domain, Projected::velocity, 0.0, u, mixture.rho, mixture.elements, dt,
                                              sharp, work, pressure[falls]);
    EXPECT_EQ(report.method, name(falls ? Method::smg : Method::star_pfmg));
  }
  for_each<Node>(domain.layout(), domain.grid.nodes(),
                 [&](Node n) { EXPECT_NEAR(pressure[1][n], pressure[0][n], 1e-5); });
}

}  // namespace
}  // namespace quicksand
