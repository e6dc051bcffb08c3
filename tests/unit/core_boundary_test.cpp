#include <gtest/gtest.h>

#include "core/boundary.hpp"
#include "core/domain.hpp"
#include "core/errors.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

using testing::planar_grid;
using testing::uniform_axis;

constexpr SideKind closed_kinds[] = {SideKind::axis, SideKind::symmetry, SideKind::free_slip, SideKind::no_slip};

TEST(CoreBoundary, ClosedSidesMirrorFractionsAndOpenOnesHaveGasOutside) {
  for (const SideKind kind : closed_kinds) EXPECT_EQ(fraction_rule({kind}, 0).alpha, 1);
  EXPECT_EQ(fraction_rule({SideKind::open}, 0).alpha, 0);
}

TEST(CoreBoundary, NothingCrossesClosedSides) {
  // The mean of a cell and its ghost is the value on the side.
  for (const SideKind kind : closed_kinds) {
    EXPECT_EQ(inviscid_velocity_rule({kind}, true).alpha, -1);
    EXPECT_EQ(viscous_velocity_rule({kind}, true).alpha, -1);
    EXPECT_EQ(potential_rule({kind}).alpha, 1);
  }
  EXPECT_EQ(inviscid_velocity_rule({SideKind::open}, true).alpha, 1);
  EXPECT_EQ(viscous_velocity_rule({SideKind::open}, true).alpha, 1);
  EXPECT_EQ(potential_rule({SideKind::open}).alpha, -1);
}

TEST(CoreBoundary, OnlyStressFeelsTheDragOfAWall) {
  for (const SideKind kind : closed_kinds) EXPECT_EQ(inviscid_velocity_rule({kind}, false).alpha, 1);
  EXPECT_EQ(viscous_velocity_rule({SideKind::no_slip}, false).alpha, -1);
  EXPECT_EQ(viscous_velocity_rule({SideKind::free_slip}, false).alpha, 1);
  EXPECT_EQ(viscous_velocity_rule({SideKind::symmetry}, false).alpha, 1);
  EXPECT_EQ(viscous_velocity_rule({SideKind::axis}, false).alpha, 1);
}

TEST(CoreBoundary, GhostsAreAffineInTheirMirrorCells) {
  const Grid<2> grid = planar_grid(4);
  CellField f(grid.layout());
  testing::set_rough(grid, f, 1);
  fill_ghosts(grid, f, [](int d, int s) { return GhostRule{d == 0 ? -1.0 : 2.0, s == 0 ? 0.5 : 0.25}; });
  for (int k = 1; k <= ghosts; ++k) {
    for (int j = 0; j < 4; ++j) {
      EXPECT_EQ(f[grid.cell({-k, j})], -f[grid.cell({k - 1, j})] + 0.5);
      EXPECT_EQ(f[grid.cell({3 + k, j})], -f[grid.cell({4 - k, j})] + 0.25);
      EXPECT_EQ(f[grid.cell({j, -k})], 2 * f[grid.cell({j, k - 1})] + 0.5);
    }
  }
}

TEST(CoreBoundary, CornersAreMirroredAlongEveryAxis) {
  const Grid<3> grid = testing::box_grid(3);
  CellField f(grid.layout());
  testing::set_rough(grid, f, 1);
  fill_ghosts(grid, f, [](int d, int) { return GhostRule{d == 1 ? -1.0 : 1.0, 0}; });
  EXPECT_EQ(f[grid.cell({-1, -2, 3})], -f[grid.cell({0, 1, 2})]);
  EXPECT_EQ(f[grid.cell({4, 1, -1})], f[grid.cell({1, 1, 0})]);
}

TEST(CoreBoundary, GhostsOfASingleCellMirrorIt) {
  const Grid<2> grid({uniform_axis(4), uniform_axis(1)}, Geometry::planar);
  CellField f(grid.layout());
  testing::set_rough(grid, f, 1);
  fill_ghosts(grid, f, [](int, int) { return GhostRule{1, 0}; });
  for (int k = 1; k <= ghosts; ++k) {
    EXPECT_EQ(f[grid.cell({2, -k})], f[grid.cell({2, 0})]);
    EXPECT_EQ(f[grid.cell({2, k})], f[grid.cell({2, 0})]);
  }
}

TEST(CoreBoundary, GhostsOfPeriodicAxesAreCopies) {
  const Grid<2> grid = Grid<2>({uniform_axis(5), uniform_axis(1)}, Geometry::planar).with_periodic({{true, true}});
  const Grid<3> half = testing::box_grid(3).with_periodic({{true, false, false}});
  CellField f(grid.layout()), g(half.layout());
  testing::set_rough(grid, f, 1);
  testing::set_rough(half, g, 1);
  const auto odd = [](int, int) { return GhostRule{-1, 0}; };
  fill_ghosts(grid, f, odd);
  fill_ghosts(half, g, odd);
  for (int k = 1; k <= ghosts; ++k) {
    EXPECT_EQ(f[grid.cell({-k, 0})], f[grid.cell({5 - k, 0})]);
    EXPECT_EQ(f[grid.cell({4 + k, 0})], f[grid.cell({k - 1, 0})]);
    EXPECT_EQ(f[grid.cell({2, k})], f[grid.cell({2, 0})]);
    EXPECT_EQ(f[grid.cell({-1, -k})], f[grid.cell({4, 0})]);
    EXPECT_EQ(g[half.cell({-k, -1, 1})], -g[half.cell({3 - k, 0, 1})]);
  }
}

TEST(CoreBoundary, PeriodicSidesComeInPairs) {
  Sides<2> sides = testing::all_sides(planar_grid(4), SideKind::periodic);
  const Domain<2> ring(planar_grid(4), sides);
  EXPECT_TRUE(ring.side_faces(0, 0).empty());
  EXPECT_EQ(ring.aperture(0, {0, 1}), 0.25);
  EXPECT_EQ(ring.aperture(0, {4, 1}), 0.25);
  EXPECT_THROW(Domain<2>(testing::tank_grid(4), sides), InputError);
  sides.at(1, 0).kind = SideKind::no_slip;
  EXPECT_THROW(Domain<2>(planar_grid(4), sides), InputError);
}

TEST(CoreBoundary, SeamsBetweenGridsAreLeftAlone) {
  const Grid<2> part({uniform_axis(8), uniform_axis(4)}, Geometry::planar, {{0, 0}, {4, 4}});
  CellField f(part.layout(), 7.0);
  testing::set_rough(part, f, 1);
  fill_ghosts(part, f, [](int, int) { return GhostRule{1, 0}; });
  EXPECT_EQ(f[part.cell({4, 2})], 7);
  EXPECT_EQ(f[part.cell({5, 2})], 7);
  EXPECT_EQ(f[part.cell({-1, 2})], f[part.cell({0, 2})]);
}

TEST(CoreBoundary, AperturesAreFaceAreasWhereLiquidCanPass) {
  Grid<2> grid = testing::tank_grid(4);
  Sides<2> sides = testing::all_sides(grid, SideKind::no_slip);
  sides.at(1, 1).kind = SideKind::open;
  const Domain<2> domain(grid, sides);
  for (int j = 0; j < 4; ++j) {
    EXPECT_EQ(domain.aperture(0, {4, j}), 0);
    EXPECT_EQ(domain.aperture(1, {j, 0}), 0);
    EXPECT_EQ(domain.aperture(1, {j, 4}), grid.area(1, {j, 4}));
    EXPECT_EQ(domain.aperture(0, {2, j}), grid.area(0, {2, j}));
  }
}

TEST(CoreBoundary, ASpeciesStandsOutside) {
  for (const SideKind kind : {SideKind::open, SideKind::inflow}) {
    Side side{kind};
    side.outside = 1;
    EXPECT_EQ(fraction_rule(side, 0).beta, 0);
    EXPECT_EQ(fraction_rule(side, 1).beta, 1);
    EXPECT_EQ(fraction_rule(side, 1).alpha, 0);
  }
}

TEST(CoreBoundary, InflowBringsItsProfile) {
  const Grid<2> grid = testing::planar_grid(8);
  Sides<2> sides = testing::all_sides(grid, SideKind::no_slip);
  sides.at(0, 0) = {SideKind::inflow, 0, 0, {{3, 0, 0}}, Profile::parabolic};
  sides.at(1, 1).kind = SideKind::free_slip;
  const Domain<2> domain(grid, sides);
  CellVectors<2> u(domain.layout(), 7);
  fill_velocity_ghosts(domain, u);
  for (int j = 0; j < 8; ++j) {
    const double z = (j + 0.5) / 8;
    EXPECT_NEAR(u[0][grid.cell({-1, j})], 3 * (1 - (1 - z) * (1 - z)), 1e-14);
    EXPECT_EQ(u[1][grid.cell({-2, j})], 0);
    EXPECT_EQ(domain.beyond[grid.cell({-1, j})], Beyond::inflow);
    EXPECT_EQ(domain.beyond[grid.cell({8, j})], Beyond::nothing);
    EXPECT_GT(domain.aperture(0, {0, j}), 0);
  }
}

}  // namespace
}  // namespace quicksand
