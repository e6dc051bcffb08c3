#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.hpp"
#include "core/grid.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

using testing::graded_axis;
using testing::uniform_axis;

template <int Dim>
double total_volume(const Grid<Dim>& grid) {
  return sum<Cell>(grid.layout(), grid.cells(), [&](Cell c) { return grid.volume(c); });
}

/// Area of the layer of faces with owned index i along d.
template <int Dim>
double layer_area(const Grid<Dim>& grid, int d, int i) {
  Box<Dim> layer = grid.cells();
  layer.lo[d] = i;
  layer.hi[d] = i + 1;
  return sum<Face>(grid.layout(), layer, [&](Face f) { return grid.area(d, grid.layout().multi(f.n)); });
}

const Grid<2> stretched_plane({graded_axis(17, -1, 2, 5), graded_axis(12, 0.5, 2, 0.2)}, Geometry::planar);
const Grid<2> stretched_tank({graded_axis(19, 0, 0.5, 6), graded_axis(11, 0, 1.5, 3)}, Geometry::axisymmetric);
const Grid<2> ring({graded_axis(9, 0.5, 2, 3), uniform_axis(5, 0, 2)}, Geometry::axisymmetric);
const Grid<3> stretched_box({graded_axis(7, 0, 2, 3), graded_axis(6, -1, 0, 0.5), uniform_axis(5, 0, 3)},
                            Geometry::cartesian);

TEST(CoreGrid, VolumesAddUpToTheDomain) {
  EXPECT_NEAR(total_volume(stretched_plane), 3 * 1.5, 1e-13);
  EXPECT_NEAR(total_volume(stretched_tank), 0.5 * 0.5 / 2 * 1.5, 1e-14);  // per radian
  EXPECT_NEAR(total_volume(ring), (4 - 0.25) / 2 * 2, 1e-13);
  EXPECT_NEAR(total_volume(stretched_box), 2 * 1 * 3, 1e-13);
}

TEST(CoreGrid, LayersOfFacesAddUpToTheCrossSection) {
  for (int i = 0; i <= 12; ++i) EXPECT_NEAR(layer_area(stretched_plane, 1, i), 3, 1e-13);
  for (int i = 0; i <= 11; ++i) EXPECT_NEAR(layer_area(stretched_tank, 1, i), 0.125, 1e-14);
  for (int i = 0; i <= 19; ++i) {
    EXPECT_NEAR(layer_area(stretched_tank, 0, i), stretched_tank.face_position(0, i) * 1.5, 1e-14);
  }
  for (int i = 0; i <= 6; ++i) EXPECT_NEAR(layer_area(stretched_box, 1, i), 6, 1e-13);
}

TEST(CoreGrid, TheAxisHasNoArea) { EXPECT_EQ(layer_area(stretched_tank, 0, 0), 0); }

TEST(CoreGrid, RadialFluxOfAUniformFieldIsTheHoopTerm) {
  // div(e_r) = 1/r: the difference of the two radial areas of a cell is V / r_c.
  for_each<Cell>(ring.layout(), ring.cells(), [&](Cell c, const Index<2>& i) {
    const double out = ring.area(0, {i[0] + 1, i[1]}) - ring.area(0, i);
    EXPECT_NEAR(out, ring.volume(c) / ring.centre_position(0, i[0]), 1e-14);
    EXPECT_EQ(ring.area(1, i), ring.area(1, {i[0], i[1] + 1}));
  });
}

TEST(CoreGrid, GhostCellsMirrorTheWidthsInside) {
  for (int d = 0; d < 2; ++d) {
    const int n = stretched_plane.owned_cells()[d];
    for (int k = 1; k <= ghosts; ++k) {
      EXPECT_NEAR(stretched_plane.width_1d(d, -k), stretched_plane.width_1d(d, k - 1), 1e-14);
      EXPECT_NEAR(stretched_plane.width_1d(d, n - 1 + k), stretched_plane.width_1d(d, n - k), 1e-14);
    }
  }
  EXPECT_NEAR(stretched_tank.volume(stretched_tank.cell({-1, 3})), stretched_tank.volume(stretched_tank.cell({0, 3})),
              1e-16);
}

TEST(CoreGrid, SmallestWidthLooksAtAllAxes) {
  EXPECT_DOUBLE_EQ(Grid<2>({uniform_axis(4), {0, 0.5, 0.6, 1}}, Geometry::planar).smallest_width(), 0.6 - 0.5);
}

TEST(CoreGrid, PartsHaveTheMetricsOfTheWhole) {
  const Grid<3>& whole = stretched_box;
  const Box<3> owned{{3, 0, 2}, {7, 4, 5}};
  const Grid<3> part({whole.global_faces(0), whole.global_faces(1), whole.global_faces(2)}, Geometry::cartesian, owned);
  EXPECT_FALSE(part.at_boundary(0, 0));
  EXPECT_TRUE(part.at_boundary(0, 1));
  EXPECT_TRUE(part.at_boundary(1, 0));
  EXPECT_FALSE(part.at_boundary(1, 1));
  EXPECT_EQ(part.global_cells(), whole.global_cells());
  EXPECT_EQ(part.smallest_width(), whole.smallest_width());
  for_each<Cell>(part.layout(), grow(part.cells(), ghosts), [&](Cell c, const Index<3>& i) {
    const Cell there = whole.cell({i[0] + 3, i[1], i[2] + 2});
    EXPECT_EQ(part.volume(c), whole.volume(there));
    for (int d = 0; d < 3; ++d) {
      EXPECT_EQ(part.width_1d(d, i[d]), whole.width_1d(d, i[d] + (d == 0 ? 3 : d == 2 ? 2 : 0)));
      EXPECT_EQ(part.area(d, i), whole.area(d, {i[0] + 3, i[1], i[2] + 2}));
    }
  });
}

TEST(CoreGrid, LineElementsIntegrateProductsOfShapeFunctionsExactly) {
  for (const bool radial : {false, true}) {
    const Grid<2> grid({graded_axis(4, 0.3, 1, 2), uniform_axis(2)},
                       radial ? Geometry::axisymmetric : Geometry::planar);
    for (int i = 0; i < 4; ++i) {
      const double a = grid.face_position(0, i);
      const double h = grid.width_1d(0, i);
      // Gauss's rule with two points is exact for cubics.
      const auto integrate = [&](auto&& f) {
        double total = 0;
        for (const double t : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)}) {
          total += h / 2 * (radial ? a + t * h : 1.0) * f(t);
        }
        return total;
      };
      const LineElement& e = grid.line_element(0, i);
      EXPECT_NEAR(e.stiffness, integrate([&](double) { return 1 / (h * h); }), 1e-13);
      EXPECT_NEAR(e.mass[0][0], integrate([](double t) { return (1 - t) * (1 - t); }), 1e-15);
      EXPECT_NEAR(e.mass[0][1], integrate([](double t) { return (1 - t) * t; }), 1e-15);
      EXPECT_NEAR(e.mass[1][1], integrate([](double t) { return t * t; }), 1e-15);
      EXPECT_EQ(e.mass[0][1], e.mass[1][0]);
      EXPECT_NEAR(e.fraction[1], integrate([](double t) { return t; }) / integrate([](double) { return 1.0; }), 1e-15);
      EXPECT_NEAR(e.fraction[0] + e.fraction[1], 1, 1e-15);
    }
  }
}

TEST(CoreGrid, RefusesAxesThatDoNotIncrease) {
  EXPECT_THROW(Grid<2>({std::vector<double>{0, 0.5, 0.5, 1}, uniform_axis(2)}, Geometry::planar), InputError);
  EXPECT_THROW(Grid<2>({std::vector<double>{0}, uniform_axis(2)}, Geometry::planar), InputError);
  EXPECT_THROW(Grid<2>({uniform_axis(4, -1, 1), uniform_axis(2)}, Geometry::axisymmetric), InputError);
}

TEST(CoreGrid, MetricsRepeatAlongPeriodicAxes) {
  const Grid<2> tube = stretched_tank.with_periodic({{false, true}});
  const int n = tube.owned_cells()[1];
  const double length = tube.face_position(1, n) - tube.face_position(1, 0);
  EXPECT_EQ(tube.nodes().hi, (Index<2>{{20, 11}}));
  EXPECT_FALSE(tube.at_boundary(1, 0));
  EXPECT_TRUE(tube.at_boundary(0, 1));
  for (int k = -ghosts; k < ghosts; ++k) {
    // From the cell below the seam to that above it, bit by bit.
    EXPECT_EQ(tube.width_1d(1, k), tube.width_1d(1, (n + k) % n));
    EXPECT_EQ(tube.width_1d(1, n + k), tube.width_1d(1, (n + k) % n));
    EXPECT_NEAR(tube.centre_position(1, n + k), tube.centre_position(1, k) + length, 1e-14);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(tube.volume(tube.cell({i, k})), tube.volume(tube.cell({i, n + k})));
      EXPECT_EQ(tube.area(0, {i, k}), tube.area(0, {i, n + k}));
      EXPECT_EQ(tube.area(1, {i, k}), tube.area(1, {i, n + k}));
    }
  }
  // A part of a periodic axis does not close.
  const Grid<2> part({stretched_tank.global_faces(0), stretched_tank.global_faces(1)}, Geometry::axisymmetric,
                     {{0, 0}, {19, 4}}, {{false, true}});
  EXPECT_FALSE(part.layout().periodic(1));
  EXPECT_EQ(part.nodes().hi[1], 5);
}

TEST(CoreGrid, TheRadiusCannotBePeriodic) { EXPECT_THROW(stretched_tank.with_periodic({{true, false}}), InputError); }

}  // namespace
}  // namespace quicksand
