#include <gtest/gtest.h>

#include <cmath>

#include "physics/convection.hpp"
#include "physics/mac_projection.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

/// One convection step of a mixture with given velocities.
template <int Dim>
struct Convection {
  Mixture<Dim>& mixture;
  CellVectors<Dim> u, acceleration, momentum;
  FaceScalars<Dim> u_mac;
  CellVectors<Dim> u_half;
  Fractions phi_tilde;
  std::vector<double> escaped;

  explicit Convection(Mixture<Dim>& m)
      : mixture(m),
        u(m.domain.layout()),
        acceleration(m.domain.layout()),
        momentum(m.domain.layout()),
        u_mac(m.domain.layout()),
        u_half(m.domain.layout()),
        phi_tilde(m.phi),
        escaped(m.species.size(), 0.0) {}

  ConvectionInput<Dim> input() const {
    return {mixture.phi, mixture.total, mixture.rho, u, acceleration, mixture.liquid, mixture.interfaces};
  }
  void advance(double dt) {
    const Domain<Dim>& domain = mixture.domain;
    fill_velocity_ghosts(domain, u);
    fill_acceleration_ghosts(domain.grid, domain.sides, acceleration);
    predict_velocities(domain, input(), dt, u_half, u_mac);
    CellField potential(domain.layout());
    project_face_velocities(domain, mixture.rho, mixture.liquid, CellField(domain.layout()),
                            {{.relative = 1e-12}, Method::automatic}, potential, u_mac);
    convect(domain, mixture.species, input(), dt, u_mac, u_half, phi_tilde, momentum, escaped);
  }
  double least_fraction() const {
    double least = 1;
    for (const CellField& phi : phi_tilde) {
      least = std::min(least, 2 - maximum<Cell>(mixture.domain.layout(), mixture.domain.grid.cells(), 0.0,
                                                [&](Cell c) { return 2 - phi[c]; }));
    }
    return least;
  }
};

/// Two species side by side in a ball, in rough motion with a Courant number near 1.
template <int Dim, class Test>
void in_rough_motion(Domain<Dim> domain, const Vec<Dim>& centre, Test&& test) {
  const Domain<Dim> d = std::move(domain);
  Mixture<Dim> mixture = testing::ball(d, testing::liquid_species(2), centre, 0.35);
  mixture.species.push_back(testing::liquid_species(1));
  mixture.phi.push_back(mixture.phi[0]);
  for_each<Cell>(d.layout(), d.grid.cells(), [&](Cell c, const Index<Dim>& i) {
    const double share = 0.5 + 0.5 * testing::rough(i, 9);
    mixture.phi[0][c] *= share;
    mixture.phi[1][c] *= 1 - share;
  });
  mixture.update();
  Convection<Dim> convection(mixture);
  convection.u = testing::rough_vectors(d.grid, 1);
  convection.acceleration = testing::rough_vectors(d.grid, 5);
  convection.advance(0.5 * d.grid.smallest_width());
  test(convection);
}

template <class Test>
void in_every_geometry(Test&& test) {
  for (const SideKind kind : {SideKind::no_slip, SideKind::open}) {
    in_rough_motion<2>(testing::make_domain(testing::stretched_grid(20), kind), {0.3, 0.5}, test);
    in_rough_motion<2>(testing::make_domain(testing::tank_grid(20), kind), {0, 0.3}, test);
    in_rough_motion<3>(testing::make_domain(testing::box_grid(10), kind), {0.3, 0.5, 0.8}, test);
  }
}

TEST(PhysicsConvection, VolumeOfEverySpeciesIsConserved) {
  in_every_geometry([](const auto& convection) {
    const auto& grid = convection.mixture.domain.grid;
    for (std::size_t i = 0; i < 2; ++i) {
      const double before = testing::integral(grid, convection.mixture.phi[i]);
      EXPECT_NEAR(testing::integral(grid, convection.phi_tilde[i]) + convection.escaped[i], before, 1e-14);
    }
  });
}

TEST(PhysicsConvection, MomentumAndMassAreCarriedTogether) {
  // A uniform velocity stays uniform, whatever the densities.
  const auto domain = testing::make_domain(testing::planar_grid(24), SideKind::open);
  Mixture<2> mixture = testing::ball<2>(domain, testing::liquid_species(2), {0.5, 0.5}, 0.3);
  mixture.species.push_back(testing::liquid_species(1e-3));
  mixture.phi.push_back(mixture.phi[0]);
  testing::set_cells(domain.grid, mixture.phi[1], [](const Vec<2>&) { return 1.0; });
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) { mixture.phi[1][c] -= mixture.phi[0][c]; });
  mixture.update();
  Convection<2> convection(mixture);
  convection.u[0].fill(0.7);
  convection.u[1].fill(-0.4);
  convection.advance(0.02);
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) {
    const double rho = 2 * convection.phi_tilde[0][c] + 1e-3 * convection.phi_tilde[1][c];
    EXPECT_NEAR(convection.momentum[0][c], 0.7 * rho, 1e-12);
    EXPECT_NEAR(convection.momentum[1][c], -0.4 * rho, 1e-12);
  });
}

TEST(PhysicsConvection, FractionsStayPositive) {
  in_every_geometry([](const auto& convection) { EXPECT_GE(convection.least_fraction(), -1e-15); });
}

TEST(PhysicsConvection, VolumeLeavesThroughOpenSidesOnly) {
  in_every_geometry([](const auto& convection) {
    const bool open = is_open(convection.mixture.domain.sides.at(0, 1));
    if (!open) {
      EXPECT_EQ(std::abs(convection.escaped[0]) + std::abs(convection.escaped[1]), 0);
    }
    if (open) {
      EXPECT_NE(convection.escaped[0] + convection.escaped[1], 0);
    }
  });
}

template <int Dim>
void expect_full_stays_full(const Domain<Dim>& domain) {
  Mixture<Dim> mixture = testing::full(domain, testing::liquid_species(1));
  Convection<Dim> convection(mixture);
  convection.u = testing::rough_vectors(domain.grid, 1);
  convection.advance(0.3 * domain.grid.smallest_width());
  EXPECT_LE(testing::largest_difference(domain.grid, convection.phi_tilde[0], mixture.phi[0]), 1e-9);
}

TEST(PhysicsConvection, WhatIsFullStaysFullInDivergenceFreeFlow) {
  expect_full_stays_full(testing::make_domain(testing::stretched_grid(20), SideKind::no_slip));
  expect_full_stays_full(testing::make_domain(testing::tank_grid(20), SideKind::no_slip));
  expect_full_stays_full(testing::make_domain(testing::box_grid(10), SideKind::no_slip));
}

TEST(PhysicsConvection, LiquidAtRestStaysAtRest) {
  const auto domain = testing::make_domain(testing::planar_grid(12), SideKind::no_slip);
  Mixture<2> mixture = testing::ball<2>(domain, testing::liquid_species(1), {0.5, 0.5}, 0.3);
  Convection<2> convection(mixture);
  convection.advance(0.1);
  EXPECT_EQ(testing::largest_difference(domain.grid, convection.phi_tilde[0], mixture.phi[0]), 0);
}

TEST(PhysicsConvection, WhatFallsOnLiquidAtRestEntersWithItsOwnVelocity) {
  // A drop above a layer at rest: the projected velocity on the layer's surface is nearly zero, the drop's is not.
  const Grid<2> grid({testing::uniform_axis(1), testing::uniform_axis(8)}, Geometry::planar);
  const auto domain = testing::make_domain(grid, SideKind::free_slip);
  Mixture<2> mixture(domain, {testing::liquid_species(1)});
  testing::set_cells(domain.grid, mixture.phi[0], [](const Vec<2>& x) {
    return x[1] < 0.5 ? 1.0 : x[1] < 0.625 ? 0.4 : 0.0;
  });
  mixture.update();
  Convection<2> convection(mixture);
  const Cell drop = domain.grid.cell({0, 4});
  convection.u[1][drop] = -1;
  convection.advance(0.025);
  const Cell top = domain.grid.cell({0, 3});
  EXPECT_GT(convection.phi_tilde[0][top], 1.05);
  EXPECT_NEAR(convection.momentum[1][top], -(convection.phi_tilde[0][top] - 1), 1e-12);
}

}  // namespace
}  // namespace quicksand
