// The surface of a bed and its crater against exact shapes.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "physics/crater.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

using testing::graded_axis;
using testing::uniform_axis;

/// Volume fractions of what lies between the ground and z = height(x): exact along z, sampled across.
template <int Dim>
CellField bed_below(const Grid<Dim>& grid, const std::function<double(const Vec<Dim>&)>& height) {
  constexpr int samples = 32;
  constexpr int up = Dim - 1;
  CellField phi(grid.layout());
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    const double low = grid.face_position(up, i[up]);
    double total = 0;
    const int points = Dim == 2 ? samples : samples * samples;
    for (int p = 0; p < points; ++p) {
      Vec<Dim> x;
      for (int d = 0, rest = p; d < up; ++d, rest /= samples) {
        x[d] = grid.face_position(d, i[d]) + grid.width_1d(d, i[d]) * (rest % samples + 0.5) / samples;
      }
      total += std::clamp((height(x) - low) / grid.width_1d(up, i[up]), 0.0, 1.0);
    }
    phi[c] = total / points;
  });
  return phi;
}

Domain<2> plane(int nx, int nz, double x_low, SideKind x_min, Geometry geometry = Geometry::planar) {
  Domain<2> domain =
      testing::make_domain<2>(Grid<2>{{uniform_axis(nx, x_low, 1), uniform_axis(nz)}, geometry}, SideKind::no_slip);
  domain.sides.at(0, 0).kind = x_min;
  return domain;
}

/// A parabola of depth 0.25 and half-width 0.5 in a bed of height 0.5, with a lip of height 0.1 at |x| = 0.75.
double parabola_with_lip(double x) {
  const double r = std::abs(x);
  if (r < 0.5) return 0.25 + r * r;
  return 0.5 + std::max(0.0, 0.1 - std::abs(r - 0.75) * 0.4);
}

TEST(BedProfile, PlanesAreExactOnUnevenGrids) {
  const Domain<2> domain = testing::make_domain<2>(
      Grid<2>{{uniform_axis(20), graded_axis(17, 0, 1, 3)}, Geometry::planar}, SideKind::no_slip);
  for (const double z : {0.0, 0.01, 0.213, 0.5, 0.87, 1.0}) {
    const BedProfile<2> profile = bed_profile(domain, bed_below<2>(domain.grid, [z](const Vec<2>&) { return z; }));
    for (const double surface : profile.surface) EXPECT_NEAR(surface, z, 1e-14);
    EXPECT_NEAR(median_height(profile), z, 1e-14);
    EXPECT_EQ(measure_crater(profile, z).whole.width[0], 0);
  }
  const Domain<2> square = testing::make_domain(testing::planar_grid(20), SideKind::no_slip);
  const BedProfile<2> slope =
      bed_profile(square, bed_below<2>(square.grid, [](const Vec<2>& x) { return 0.1 + 0.7 * x[0]; }));
  for (std::size_t n = 0; n < 20; ++n) EXPECT_NEAR(slope.surface[n], 0.1 + 0.7 * slope.axes[0].centre[n], 1e-3);
}

TEST(BedProfile, SprayAndSuspensionDoNotCount) {
  const Domain<2> domain = plane(16, 32, 0, SideKind::no_slip);
  CellField phi = bed_below<2>(domain.grid, [](const Vec<2>&) { return 0.25; });
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<2>& i) {
    if (i[1] >= 10) phi[c] = 0.02 + (i[0] % 2 ? 0.3 : 0.0);
    if (i[0] >= 4 && i[0] < 8 && i[1] >= 20 && i[1] < 24) phi[c] = 1;  // a blob in the air
  });
  const BedProfile<2> profile = bed_profile(domain, phi);
  for (const double surface : profile.surface) EXPECT_NEAR(surface, 0.25, 1e-14);
  EXPECT_EQ(profile.surface, profile.top);
}

TEST(BedProfile, CavitiesAndOverhangs) {
  const Domain<2> domain = plane(16, 32, 0, SideKind::no_slip);
  CellField phi = bed_below<2>(domain.grid, [](const Vec<2>&) { return 0.5; });
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<2>& i) {
    if (i[0] >= 4 && i[0] < 8 && i[1] >= 8 && i[1] < 12) phi[c] = 0;  // a cavity with a roof
    if (i[0] >= 10 && i[1] == 6) phi[c] = 0.2;                        // a gap of one cell
  });
  const BedProfile<2> profile = bed_profile(domain, phi);
  for (std::size_t n = 0; n < 16; ++n) {
    EXPECT_NEAR(profile.surface[n], n >= 4 && n < 8 ? 0.25 : 0.5, 1e-14) << n;
    EXPECT_NEAR(profile.top[n], 0.5, 1e-14) << n;
  }
  const Crater<2> crater = measure_crater(profile, 0.5);
  EXPECT_NEAR(crater.whole.volume, 0.25 * 0.25, 1e-14);
  EXPECT_EQ(crater.open.volume, 0);
  EXPECT_EQ(crater.open.width[0], 0);
}

TEST(Crater, ParabolaWithLip) {
  for (const int n : {20, 40, 80}) {
    const Domain<2> domain = plane(2 * n, n, -1, SideKind::no_slip);
    const BedProfile<2> profile =
        bed_profile(domain, bed_below<2>(domain.grid, [](const Vec<2>& x) { return parabola_with_lip(x[0]); }));
    const Crater<2> crater = measure_crater(profile, 0.5);
    const double h = 1.0 / n;
    EXPECT_NEAR(crater.whole.depth, 0.25, 0.5 * h * h);
    EXPECT_NEAR(crater.whole.deepest[0], 0, h);
    EXPECT_NEAR(crater.whole.width[0], 1, h);
    EXPECT_NEAR(crater.whole.volume, 1.0 / 6, h * h);
    EXPECT_NEAR(crater.lip_height, 0.1, 0.3 * h);
    EXPECT_NEAR(std::abs(crater.lip[0]), 0.75, h);
    EXPECT_NEAR(crater.volume_of_lip, 2 * 0.025, h * h);
    EXPECT_EQ(crater.open.volume, crater.whole.volume);
    EXPECT_EQ(crater.open.width[0], crater.whole.width[0]);
  }
}

TEST(Crater, HalfIsReportedAsTheWhole) {
  const auto height = [](const Vec<2>& x) { return parabola_with_lip(x[0]); };
  const Domain<2> whole = plane(80, 40, -1, SideKind::no_slip);
  const Crater<2> all = measure_crater(bed_profile(whole, bed_below<2>(whole.grid, height)), 0.5);
  const Domain<2> part = plane(40, 40, 0, SideKind::symmetry);
  const Crater<2> half = measure_crater(bed_profile(part, bed_below<2>(part.grid, height)), 0.5);
  EXPECT_NEAR(half.whole.depth, all.whole.depth, 1e-12);
  EXPECT_NEAR(half.whole.width[0], all.whole.width[0], 1e-12);
  EXPECT_NEAR(half.whole.volume, all.whole.volume, 1e-12);
  EXPECT_NEAR(half.volume_of_lip, all.volume_of_lip, 1e-12);
}

TEST(Crater, WholeCircle) {
  const Domain<2> domain = plane(50, 50, 0, SideKind::axis, Geometry::axisymmetric);
  const BedProfile<2> profile =
      bed_profile(domain, bed_below<2>(domain.grid, [](const Vec<2>& x) { return parabola_with_lip(x[0]); }));
  EXPECT_NEAR(median_height(profile), 0.5, 0.05);
  const Crater<2> crater = measure_crater(profile, 0.5);
  EXPECT_NEAR(crater.whole.width[0], 1, 0.02);
  EXPECT_NEAR(crater.whole.volume, std::numbers::pi / 32, 1e-4);
}

TEST(Crater, CentralPeakAndDistantRippleDoNotChangeTheWidth) {
  const Domain<2> domain = plane(80, 80, -1, SideKind::no_slip);
  const BedProfile<2> profile = bed_profile(domain, bed_below<2>(domain.grid, [](const Vec<2>& x) {
                                              const double r = std::abs(x[0]);
                                              if (r < 0.1) return 0.6;
                                              return r < 0.5 ? 0.25 + r * r : r > 0.8 ? 0.49 : 0.51;
                                            }));
  EXPECT_NEAR(measure_crater(profile, 0.5).whole.width[0], 1, 0.03);
}

TEST(Crater, ThreeDimensions) {
  Domain<3> domain = testing::make_domain<3>(
      Grid<3>{{uniform_axis(24), uniform_axis(32, -1, 1), uniform_axis(24)}, Geometry::cartesian}, SideKind::no_slip);
  domain.sides.at(0, 0).kind = SideKind::symmetry;
  // An elliptic paraboloid with half-widths 0.5 and 0.7.
  const BedProfile<3> profile =
      bed_profile(domain, bed_below<3>(domain.grid, [](const Vec<3>& x) {
                    return std::min(0.5, 0.25 + 0.25 * (x[0] * x[0] / 0.25 + x[1] * x[1] / 0.49));
                  }));
  EXPECT_NEAR(median_height(profile), 0.5, 1e-14);
  const Crater<3> crater = measure_crater(profile, 0.5);
  EXPECT_NEAR(crater.whole.depth, 0.25, 2e-3);
  EXPECT_NEAR(crater.whole.width[0], 1, 0.05);
  EXPECT_NEAR(crater.whole.width[1], 1.4, 0.05);
  EXPECT_NEAR(crater.whole.volume, std::numbers::pi * 0.5 * 0.7 * 0.25 / 2, 1e-3);
  EXPECT_EQ(crater.lip_height, 0);
}

}  // namespace
}  // namespace quicksand
