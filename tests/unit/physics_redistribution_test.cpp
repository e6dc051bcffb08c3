#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.hpp"
#include "physics/energy.hpp"
#include "physics/redistribution.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

constexpr double volume_tolerance = 1e-9;

/// A lump that is packed to 1.4 in its middle and thins out towards its rim, with rough velocities.
template <int Dim>
struct Lump {
  Domain<Dim> domain;
  Mixture<Dim> mixture;
  Fractions phi_tilde;
  CellField rho_tilde;
  CellVectors<Dim> u_tilde, momentum, u_bar;
  RedistributionWork<Dim> work;
  std::vector<double> escaped;

  Lump(Domain<Dim> d, const Vec<Dim>& centre, double radius)
      : domain(std::move(d)),
        mixture(domain, {testing::liquid_species(1.7)}),
        rho_tilde(domain.layout()),
        u_tilde(testing::rough_vectors(domain.grid, 3)),
        momentum(domain.layout()),
        u_bar(domain.layout()),
        work(domain, mixture.species),
        escaped(1, 0.0) {
    testing::set_cells(domain.grid, mixture.phi[0], [&](const Vec<Dim>& x) {
      return std::clamp(1.4 - std::pow(testing::distance(x, centre) / radius, 4), 0.0, 1.4);
    });
  }

  void redistribute() {
    mixture.update();
    phi_tilde = mixture.phi;
    rho_tilde = mixture.rho;
    for (int e = 0; e < Dim; ++e) {
      for_each<Cell>(domain.layout(), domain.grid.cells(),
                     [&](Cell c) { momentum[e][c] = rho_tilde[c] * u_tilde[e][c]; });
    }
    redistribute_volume(domain, mixture.species, {.tolerance = volume_tolerance}, work, mixture.phi, escaped);
    mixture.update();
    redistribute_momentum(domain, momentum, mixture.rho, {{.relative = 1e-13}, Method::jacobi}, work, u_bar);
  }
  double total_momentum(int e) const {
    return sum<Cell>(domain.layout(), domain.grid.cells(),
                     [&](Cell c) { return domain.grid.volume(c) * mixture.rho[c] * u_bar[e][c]; });
  }
  double largest_total() const {
    return maximum<Cell>(domain.layout(), domain.grid.cells(), 0.0, [&](Cell c) { return mixture.total[c]; });
  }
};

/// In the middle, where it meets no side.
Lump<2> free_lump() { return {testing::make_domain(testing::stretched_grid(24), SideKind::no_slip), {0.5, 0.5}, 0.25}; }
/// In a corner between walls, and on the axis between floor and lid.
Lump<2> corner_lump() { return {testing::make_domain(testing::planar_grid(24), SideKind::no_slip), {0.1, 0.1}, 0.3}; }
Lump<2> axis_lump() { return {testing::make_domain(testing::tank_grid(24), SideKind::no_slip), {0.0, 0.1}, 0.3}; }
Lump<2> open_lump() { return {testing::make_domain(testing::planar_grid(24), SideKind::open), {0.05, 0.5}, 0.3}; }
Lump<3> lump_in_space() {
  return {testing::make_domain(testing::box_grid(14), SideKind::no_slip), {0.2, 0.5, 0.5}, 0.3};
}

template <class Test>
void for_every_lump(Test&& test) {
  test(free_lump());
  test(corner_lump());
  test(axis_lump());
  test(open_lump());
  test(lump_in_space());
}

TEST(PhysicsRedistribution, NoCellIsOverfullAndNoneIsInDebt) {
  for_every_lump([](auto lump) {
    lump.redistribute();
    EXPECT_LE(lump.largest_total(), 1 + volume_tolerance);
    const double least = -maximum<Cell>(lump.domain.layout(), lump.domain.grid.cells(), 0.0,
                                        [&](Cell c) { return -lump.mixture.phi[0][c]; });
    EXPECT_GE(least, 0);
    const double deepest =
        maximum<Cell>(lump.domain.layout(), lump.domain.grid.cells(), 0.0, [&](Cell c) { return -lump.work.H[c]; });
    EXPECT_EQ(deepest, 0);
  });
}

TEST(PhysicsRedistribution, VolumeIsConserved) {
  for_every_lump([](auto lump) {
    lump.redistribute();
    const double before = testing::integral(lump.domain.grid, lump.phi_tilde[0]);
    EXPECT_NEAR(testing::integral(lump.domain.grid, lump.mixture.phi[0]) + lump.escaped[0], before, 1e-14 * before);
  });
}

TEST(PhysicsRedistribution, VolumeLeavesThroughOpenSidesOnly) {
  for_every_lump([](auto lump) {
    lump.redistribute();
    const bool open = is_open(lump.domain.sides.at(0, 1));
    if (open) {
      EXPECT_GT(lump.escaped[0], 1e-4);
    }
    if (!open) {
      EXPECT_NEAR(lump.escaped[0], 0, 1e-15);
    }
  });
}

TEST(PhysicsRedistribution, UniformVelocityStaysUniform) {
  // Row sums of the operator: the momentum of what moves is that of the mass it makes up.
  auto lump = free_lump();
  for (int e = 0; e < 2; ++e) lump.u_tilde[e].fill(e + 1.0);
  lump.redistribute();
  for (int e = 0; e < 2; ++e) {
    for_each<Cell>(lump.domain.layout(), lump.domain.grid.cells(), [&](Cell c) {
      if (lump.mixture.rho[c] > 1e-8) {
        EXPECT_NEAR(lump.u_bar[e][c], e + 1.0, 1e-9);
      }
    });
  }
}

TEST(PhysicsRedistribution, MotionAlongTheAxisStaysUniform) {
  Lump<2> lump(testing::make_domain(testing::tank_grid(24), SideKind::no_slip), {0.0, 0.5}, 0.3);
  lump.u_tilde[0].fill(0);
  lump.u_tilde[1].fill(2);
  lump.redistribute();
  for_each<Cell>(lump.domain.layout(), lump.domain.grid.cells(), [&](Cell c) {
    EXPECT_EQ(lump.u_bar[0][c], 0);
    if (lump.mixture.rho[c] > 1e-8) {
      EXPECT_NEAR(lump.u_bar[1][c], 2, 1e-9);
    }
  });
}

TEST(PhysicsRedistribution, MomentumIsConservedAwayFromWalls) {
  auto lump = free_lump();
  lump.redistribute();
  for (int e = 0; e < 2; ++e) {
    EXPECT_NEAR(lump.total_momentum(e), testing::integral(lump.domain.grid, lump.momentum[e]), 1e-14);
  }
}

TEST(PhysicsRedistribution, WallsTakeNormalMomentumOnly) {
  Lump<2> lump(testing::make_domain(testing::planar_grid(24), SideKind::no_slip), {0.0, 0.5}, 0.3);
  lump.u_tilde[0].fill(-1);
  lump.redistribute();
  EXPECT_NEAR(lump.total_momentum(1), testing::integral(lump.domain.grid, lump.momentum[1]), 1e-14);
  EXPECT_GT(lump.total_momentum(0), testing::integral(lump.domain.grid, lump.momentum[0]) + 1e-4);
}

TEST(PhysicsRedistribution, KineticEnergyNeverRises) {
  for_every_lump([](auto lump) {
    lump.redistribute();
    const double before = kinetic_energy_of_momentum(lump.domain.grid, lump.rho_tilde, lump.momentum);
    const double after = kinetic_energy(lump.domain.grid, lump.mixture.rho, lump.u_bar);
    EXPECT_LE(after, before * (1 + 1e-12));
    EXPECT_LT(after, 0.999 * before);  // rough motion must lose some
  });
}

TEST(PhysicsRedistribution, VelocitiesStayWithinThoseBefore) {
  for_every_lump([](auto lump) {
    lump.redistribute();
    // Walls at rest count too: 0 lies within the rough numbers' range [-1, 1].
    for (auto& component : lump.u_bar.component) {
      const double largest = maximum<Cell>(lump.domain.layout(), lump.domain.grid.cells(), 0.0, [&](Cell c) {
        return lump.mixture.rho[c] > 1e-8 ? std::abs(component[c]) : 0.0;
      });
      EXPECT_LE(largest, 1 + 1e-9);
    }
  });
}

TEST(PhysicsRedistribution, WithoutExcessNothingMoves) {
  Lump<2> lump(testing::make_domain(testing::planar_grid(16), SideKind::no_slip), {0.5, 0.5}, 0.3);
  testing::set_cells(lump.domain.grid, lump.mixture.phi[0], [](const Vec<2>& x) { return x[1] < 0.5 ? 1.0 : 0.3; });
  lump.redistribute();
  for_each<Cell>(lump.domain.layout(), lump.domain.grid.cells(), [&](Cell c) {
    EXPECT_EQ(lump.mixture.phi[0][c], lump.phi_tilde[0][c]);
    EXPECT_DOUBLE_EQ(lump.u_bar[0][c], lump.u_tilde[0][c]);
  });
}

TEST(PhysicsRedistribution, TheFirstSpeciesKeepsItsPlace) {
  const auto domain = testing::make_domain(testing::planar_grid(16), SideKind::no_slip);
  Mixture<2> mixture(domain, {testing::liquid_species(2), testing::liquid_species(1)});
  testing::set_cells(domain.grid, mixture.phi[0], [](const Vec<2>& x) { return x[0] < 0.5 ? 0.8 : 0.0; });
  testing::set_cells(domain.grid, mixture.phi[1], [](const Vec<2>& x) { return x[0] < 0.5 ? 0.5 : 0.2; });
  const Fractions before = mixture.phi;
  RedistributionWork<2> work(domain, mixture.species);
  std::vector<double> escaped(2, 0.0);
  redistribute_volume(domain, mixture.species, {.tolerance = volume_tolerance}, work, mixture.phi, escaped);
  mixture.update();
  EXPECT_EQ(testing::largest_difference(domain.grid, mixture.phi[0], before[0]), 0);
  EXPECT_GT(testing::largest_difference(domain.grid, mixture.phi[1], before[1]), 0.2);
  for_each<Cell>(domain.layout(), domain.grid.cells(),
                 [&](Cell c) { EXPECT_LE(mixture.total[c], 1 + volume_tolerance); });
}

TEST(PhysicsRedistribution, AClosedBoxWithoutRoomIsRefused) {
  Lump<2> lump(testing::make_domain(testing::planar_grid(8), SideKind::no_slip), {0.5, 0.5}, 0.3);
  lump.mixture.phi[0].fill(1.01);
  EXPECT_THROW(lump.redistribute(), NumericalError);
}

/// A pile that is too high along x, the same all along a ring of n cells round y.
Lump<2> pile_on_ring(int n) {
  const Grid<2> grid{{testing::uniform_axis(16), testing::uniform_axis(n, 0, 0.1 * n)}, Geometry::planar};
  Sides<2> sides = testing::all_sides(grid, SideKind::free_slip);
  sides.at(1, 0).kind = sides.at(1, 1).kind = SideKind::periodic;
  Lump<2> pile(Domain<2>(grid, sides), {0.5, 0.0}, 1);
  testing::set_cells(pile.domain.grid, pile.mixture.phi[0],
                     [](const Vec<2>& x) { return std::clamp(1.5 - 5 * std::abs(x[0] - 0.5), 0.0, 1.4); });
  for (int d = 0; d < 2; ++d) {
    testing::set_cells(pile.domain.grid, pile.u_tilde[d], [&](const Vec<2>& x) { return std::sin(9 * x[0] + d); });
  }
  pile.redistribute();
  return pile;
}

TEST(PhysicsRedistribution, TheNumberOfCellsRoundARingDoesNotMatter) {
  const Lump<2> one = pile_on_ring(1);
  for (const int n : {2, 3}) {
    const Lump<2> more = pile_on_ring(n);
    for (int i = 0; i < 16; ++i) {
      for (int d = 0; d < 2; ++d) {
        EXPECT_NEAR(one.u_bar[d][one.domain.grid.cell({i, 0})], more.u_bar[d][more.domain.grid.cell({i, 1})], 1e-9);
      }
    }
    for (int d = 0; d < 2; ++d) EXPECT_NEAR(n * one.total_momentum(d), more.total_momentum(d), 1e-10);
  }
}

}  // namespace
}  // namespace quicksand
