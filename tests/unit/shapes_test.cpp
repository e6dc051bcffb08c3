// Volume fractions of shapes against exact areas and volumes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/shapes.hpp"

namespace quicksand {
namespace {

constexpr double pi = std::numbers::pi;

std::vector<double> uniform(double from, double to, int cells) {
  std::vector<double> faces;
  for (int i = 0; i <= cells; ++i) faces.push_back(from + (to - from) * i / cells);
  return faces;
}

Grid<2> plane(Geometry geometry, int n = 13) {
  return Grid<2>({uniform(geometry == Geometry::axisymmetric ? 0 : -1, 1, n), uniform(-1, 1, n + 2)}, geometry);
}

Grid<3> cube(int n = 9) {
  return Grid<3>({uniform(-1, 1, n), uniform(-1, 1, n + 1), uniform(-1, 1, n + 2)}, Geometry::cartesian);
}

/// Volume of a shape on a grid (per radian in axisymmetric grids); checks that every fraction is within [0, 1].
template <int Dim>
double volume(const Shape& shape, const Grid<Dim>& grid) {
  CellField phi(grid.layout());
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) { phi[c] = fraction(shape, grid, i); });
  const auto outside = [&](Cell c) { return phi[c] < 0 || phi[c] > 1 ? 1.0 : 0.0; };
  EXPECT_EQ(sum<Cell>(grid.layout(), grid.cells(), outside), 0);
  return sum<Cell>(grid.layout(), grid.cells(), [&](Cell c) { return phi[c] * grid.volume(c); });
}

TEST(Shapes, PlanarAreas) {
  const Grid<2> grid = plane(Geometry::planar);
  EXPECT_NEAR(volume(BoxShape{Vec<3>{{-0.33, 0, -0.21}}, Vec<3>{{0.5, 0, 0.77}}}, grid), 0.83 * 0.98, 1e-13);
  EXPECT_NEAR(volume(LayerShape{-0.5, 0.123}, grid), 2 * 0.623, 1e-13);
  EXPECT_NEAR(volume(CylinderShape{Vec<3>{{0.1, 9, -0.5}}, 0.3, 0.7}, grid), 0.6 * 0.7, 1e-13);
  EXPECT_NEAR(volume(SphereShape{Vec<3>{{0.1, 9, -0.05}}, 0.61}, grid), pi * 0.61 * 0.61, 1e-12);
  EXPECT_NEAR(volume(PolygonShape{{{-0.5, -0.5}, {0.6, -0.4}, {0.1, 0.7}}}, grid), 0.5 * (1.1 * 1.2 - 0.6 * 0.1),
              1e-13);
  EXPECT_NEAR(volume(PolygonShape{{{0.1, 0.7}, {0.6, -0.4}, {-0.5, -0.5}}}, grid), 0.63, 1e-13) << "clockwise";
  EXPECT_NEAR(volume(HalfSpaceShape{Vec<3>{{0, 0, 0.2}}, Vec<3>{{0, 0, 3}}}, grid), 2 * 1.2, 1e-13);
  EXPECT_NEAR(volume(HalfSpaceShape{Vec<3>{{0, 0, 0}}, Vec<3>{{1, 7, -2}}}, grid), 2, 1e-13);
}

TEST(Shapes, ConcavePolygon) {
  // A square with a notch that reaches its middle; a cell may see two separate parts.
  const PolygonShape notched{{{-0.7, -0.7}, {0.7, -0.7}, {0.7, 0.7}, {0, 0}, {-0.7, 0.7}}};
  EXPECT_NEAR(volume(notched, plane(Geometry::planar, 5)), 1.4 * 1.4 * 0.75, 1e-13);
}

TEST(Shapes, AxisymmetricVolumesPerRadian) {
  const Grid<2> grid = plane(Geometry::axisymmetric);
  EXPECT_NEAR(volume(CylinderShape{Vec<3>{{0, 0, -0.5}}, 0.33, 0.7}, grid), 0.33 * 0.33 / 2 * 0.7, 1e-14);
  EXPECT_NEAR(volume(SphereShape{Vec<3>{{0, 0, 0.1}}, 0.77}, grid), 2 * std::pow(0.77, 3) / 3, 1e-13);
  EXPECT_NEAR(volume(BoxShape{Vec<3>{{0.2, 0, -0.3}}, Vec<3>{{0.5, 0, 0.4}}}, grid), (0.25 - 0.04) / 2 * 0.7, 1e-14);
  EXPECT_NEAR(volume(LayerShape{-0.5, 0.123}, grid), 0.5 * 0.623, 1e-13);
  // A cone of radius 0.6 and height 0.9.
  EXPECT_NEAR(volume(PolygonShape{{{0, 0}, {0.6, 0}, {0, 0.9}}}, grid), 0.36 * 0.9 / 6, 1e-14);
  // Below z = r: the integral of r (r + 1) dr.
  EXPECT_NEAR(volume(HalfSpaceShape{Vec<3>{{0, 0, 0}}, Vec<3>{{-1, 0, 1}}}, grid), 1.0 / 3 + 0.5, 1e-13);
}

TEST(Shapes, VolumesInSpace) {
  const Grid<3> grid = cube();
  EXPECT_NEAR(volume(BoxShape{Vec<3>{{-0.3, -0.2, -0.1}}, Vec<3>{{0.5, 0.6, 0.7}}}, grid), 0.512, 1e-13);
  EXPECT_NEAR(volume(CylinderShape{Vec<3>{{0.1, -0.1, -0.5}}, 0.37, 0.9}, grid), pi * 0.37 * 0.37 * 0.9, 1e-12);
  EXPECT_NEAR(volume(SphereShape{Vec<3>{{0.1, -0.1, 0.05}}, 0.71}, grid), 4 * pi / 3 * std::pow(0.71, 3), 1e-13);
  EXPECT_NEAR(volume(PolygonShape{{{0, 0}, {0.6, 0}, {0, 0.9}}}, grid), 2 * 0.27, 1e-13);
  EXPECT_NEAR(volume(HalfSpaceShape{Vec<3>{{0, 0, 0}}, Vec<3>{{1, 2, 3}}}, grid), 4, 1e-12);
  // The corner x + y + z <= -2 of the cube is a tetrahedron with legs 1.
  EXPECT_NEAR(volume(HalfSpaceShape{Vec<3>{{-1, -1, 0}}, Vec<3>{{1, 1, 1}}}, grid), 1.0 / 6, 1e-13);
  EXPECT_NEAR(volume(LayerShape{-0.5, 0.123}, grid), 4 * 0.623, 1e-13);
}

TEST(Shapes, QuarterCylinderCrossesPlanesOfSymmetry) {
  const Grid<3> quarter({uniform(0, 0.5, 16), uniform(0, 0.5, 16), uniform(0, 1.5, 48)}, Geometry::cartesian);
  EXPECT_NEAR(volume(CylinderShape{Vec<3>{{0, 0, 0}}, 0.25, 1}, quarter), pi / 64, 1e-13);
}

TEST(Shapes, Waves) {
  const double k = pi;
  const WaveShape below{-1.0, std::nullopt, 0.1, 0.05, k};
  const WaveShape above{std::nullopt, 1.0, 0.1, 0.05, k};
  const Grid<2> planar = plane(Geometry::planar);
  EXPECT_NEAR(volume(below, planar), 2 * 1.1 + 0.1 * std::sin(k) / k, 1e-12);
  EXPECT_NEAR(volume(below, planar) + volume(above, planar), 4, 1e-12);
  // Integral of r J0(k r) = r J1(k r)/k.
  EXPECT_NEAR(volume(below, plane(Geometry::axisymmetric)), 1.1 / 2 + 0.05 * std::cyl_bessel_j(1, k) / k, 1e-12);
  EXPECT_NEAR(volume(below, cube()), 4 * 1.1, 1e-12);
}

TEST(Shapes, CellsOnAFaceAreFullOrEmpty) {
  const Grid<2> grid({uniform(0, 0.5, 16), uniform(0, 1.5, 48)}, Geometry::axisymmetric);
  const Shape slug = CylinderShape{Vec<3>{{0, 0, 0}}, 0.25, 1};
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell, const Index<2>& i) {
    EXPECT_EQ(fraction(slug, grid, i), i[0] < 8 && i[1] < 32 ? 1.0 : 0.0);
  });
}

TEST(Shapes, DiscWithinOneCell) {
  const Extent cell{Vec<3>{{-1, 0, -1}}, Vec<3>{{1, 1, 1}}};
  EXPECT_NEAR(fraction(SphereShape{Vec<3>{{0.2, 0, 0.1}}, 0.05}, cell, Geometry::planar), pi * 0.0025 / 4, 1e-14);
  const Extent corner{Vec<3>{{0, 0, 0}}, Vec<3>{{1, 1, 1}}};
  EXPECT_NEAR(fraction(SphereShape{Vec<3>{{0, 0, 0}}, 1}, corner, Geometry::planar), pi / 4, 1e-14);
  EXPECT_NEAR(fraction(SphereShape{Vec<3>{{0, 0, 0}}, 1}, corner, Geometry::cartesian), pi / 6, 1e-14);
}

/// Axis with widths that grow by a constant factor.
std::vector<double> growing(double from, double to, int cells, double factor) {
  std::vector<double> faces;
  for (int i = 0; i <= cells; ++i) {
    faces.push_back(from + (to - from) * (std::pow(factor, i) - 1) / (std::pow(factor, cells) - 1));
  }
  return faces;
}

TEST(Shapes, BallsOfFewCellsOnStretchedGridsHaveTheirVolume) {
  // Radii of about 1, 4 and 10 cells.
  for (const double radius : {0.11, 0.41, 0.93}) {
    const Shape ball = SphereShape{Vec<3>{{0.013, -0.021, 0.034}}, radius};
    const Shape on_axis = SphereShape{Vec<3>{{0, 0, 0.034}}, radius};
    const double exact = 4 * pi / 3 * std::pow(radius, 3);
    const Grid<3> space({growing(-1, 1, 19, 1.07), uniform(-1, 1, 20), growing(-1, 1, 23, 0.95)}, Geometry::cartesian);
    EXPECT_NEAR(volume(ball, space) / exact, 1, 1e-13) << radius;
    const Grid<2> turned({growing(0, 1, 10, 1.07), growing(-1, 1, 23, 0.95)}, Geometry::axisymmetric);
    EXPECT_NEAR(volume(on_axis, turned) * 2 * pi / exact, 1, 1e-13) << radius;
    const Grid<2> planar({growing(-1, 1, 19, 1.07), growing(-1, 1, 23, 0.95)}, Geometry::planar);
    EXPECT_NEAR(volume(ball, planar) / (pi * radius * radius), 1, 1e-13) << radius;
  }
}

TEST(Shapes, CellsOfABallAddUpHoweverTheyAreCut) {
  // Halves of a cell against the whole: errors of single cells would show, which sums over a grid may hide.
  double worst = 0;
  for (const double radius : {0.3, 1.0, 3.7, 30.0}) {
    for (int n = 0; n < 400; ++n) {
      const double theta = 0.1 + 0.007 * n;
      const double phi = 1.7 * n;
      const Vec<3> corner{{radius * std::sin(theta) * std::cos(phi) - 0.4,
                           radius * std::sin(theta) * std::sin(phi) - 0.5, radius * std::cos(theta) - 0.6}};
      const auto part = [&](int d, double from, double to) {
        Extent box{corner, Vec<3>{{corner[0] + 1, corner[1] + 1, corner[2] + 1}}};
        box.low[d] = corner[d] + from;
        box.high[d] = corner[d] + to;
        return (to - from) * fraction(SphereShape{Vec<3>{{0, 0, 0}}, radius}, box, Geometry::cartesian);
      };
      for (int d = 0; d < 3; ++d) {
        worst = std::max(worst, std::abs(part(d, 0, 0.37) + part(d, 0.37, 1) - part(d, 0, 1)));
      }
    }
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(Shapes, CellsCutByAWave) {
  // A crest through the top of a cell: 2/pi of a half wave less what is cut off, by exact areas.
  const double k = pi;
  const double top = 0.5;
  const WaveShape wave{-9.0, std::nullopt, 0, 1, k};
  const Extent cell{Vec<3>{{-0.5, 0, 0}}, Vec<3>{{0.5, 1, top}}};
  const double x = std::acos(top) / k;  // where the wave passes the top
  const double exact = 2 * (top * x + (1 - std::sin(k * x)) / k);
  EXPECT_NEAR(fraction(wave, cell, Geometry::planar), exact / top, 1e-12);
  const Extent ring{Vec<3>{{0, 0, 0}}, Vec<3>{{1, 1, top}}};
  double low = 0;
  double high = 2.4 / k;  // below the first zero of J0
  for (int n = 0; n < 60; ++n) {
    (std::cyl_bessel_j(0, k * (low + high) / 2) > top ? low : high) = (low + high) / 2;
  }
  const double zero = 2.404825557695773 / k;
  const auto integral = [&](double r) { return r * std::cyl_bessel_j(1, k * r) / k; };  // of r J0(k r)
  const double filled = top * low * low / 2 + integral(zero) - integral(low);
  EXPECT_NEAR(fraction(wave, ring, Geometry::axisymmetric), filled / (top / 2), 1e-12);
}

TEST(Shapes, BoundsAndContains) {
  const Shape disc = SphereShape{Vec<3>{{0.5, 0, 0.5}}, 0.25};
  EXPECT_EQ(bounds(disc, Geometry::planar).low[0], 0.25);
  EXPECT_TRUE(contains(disc, Vec<3>{{0.5, 7, 0.7}}, Geometry::planar)) << "y plays no part in two dimensions";
  EXPECT_FALSE(contains(disc, Vec<3>{{0.5, 7, 0.7}}, Geometry::cartesian));
  EXPECT_TRUE(std::isinf(bounds(LayerShape{0, 1}, Geometry::planar).low[0]));
  EXPECT_EQ(bounds(HalfSpaceShape{Vec<3>{{0, 0, 0.3}}, Vec<3>{{0, 0, 2}}}, Geometry::planar).high[2], 0.3);
}

TEST(Shapes, Overlap) {
  const Extent domain{Vec<3>{{0, 0, 0}}, Vec<3>{{1, 1, 1}}};
  const Shape low = LayerShape{0, 0.5};
  const auto overlaps = [&](const Shape& a, const Shape& b, Geometry geometry = Geometry::planar) {
    return overlap(a, b, domain, geometry);
  };
  EXPECT_FALSE(overlaps(low, LayerShape{0.5, 1}));
  EXPECT_TRUE(overlaps(low, LayerShape{0.4999, 1}));
  EXPECT_TRUE(overlaps(low, SphereShape{Vec<3>{{0.5, 0, 0.7}}, 0.21}));
  EXPECT_FALSE(overlaps(low, SphereShape{Vec<3>{{0.5, 0, 0.75}}, 0.25}));
  // Bounding boxes meet, discs do not.
  EXPECT_FALSE(overlaps(SphereShape{Vec<3>{{0.25, 0, 0.25}}, 0.25}, SphereShape{Vec<3>{{0.65, 0, 0.65}}, 0.25}));
  EXPECT_FALSE(overlaps(WaveShape{0.0, std::nullopt, 0.5, 0.1, 3.14}, WaveShape{std::nullopt, 1.0, 0.5, 0.1, 3.14}));
  EXPECT_TRUE(overlaps(low, BoxShape{Vec<3>{{0.2, 0.2, 0.2}}, Vec<3>{{0.21, 0.21, 0.21}}}, Geometry::cartesian));
  EXPECT_FALSE(overlaps(PolygonShape{{{0, 0}, {1, 0}, {0, 1}}}, PolygonShape{{{1, 0}, {1, 1}, {0, 1}}}));
}

}  // namespace
}  // namespace quicksand
