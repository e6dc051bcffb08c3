#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "physics/plane.hpp"

namespace quicksand {
namespace {

/// Part of the unit cube below the plane by inclusion and exclusion of its corners, which cancels badly for small m but
/// is short.
template <int Dim>
double by_corners(const Vec<Dim>& m, double alpha) {
  double total = 0;
  double product = 1;
  for (int d = 0; d < Dim; ++d) product *= (d + 1) * m[d];
  for (int k = 0; k < (1 << Dim); ++k) {
    double rest = alpha;
    double sign = 1;
    for (int d = 0; d < Dim; ++d) {
      if ((k >> d) & 1) {
        rest -= m[d];
        sign = -sign;
      }
    }
    total += sign * std::pow(std::max(rest, 0.0), Dim);
  }
  return total / product;
}

/// All orders of magnitude of the components, with m1 + m2 below and above m3.
const std::vector<Vec<3>> normals3 = {{0.2, 0.3, 0.5},          {0.1, 0.2, 0.7},   {0.3, 0.33, 0.37}, {0.6, 0.1, 0.3},
                                      {1. / 3, 1. / 3, 1. / 3}, {0.45, 0.45, 0.1}, {0.02, 0.49, 0.49}};
const std::vector<Vec<2>> normals2 = {{0.5, 0.5}, {0.1, 0.9}, {0.8, 0.2}, {0.3, 0.7}};

TEST(PhysicsPlane, CutFractionIsExactInSpace) {
  for (const Vec<3>& m : normals3) {
    for (int i = 0; i <= 40; ++i) EXPECT_NEAR(cut_fraction(m, i / 40.0), by_corners(m, i / 40.0), 1e-13);
  }
}

TEST(PhysicsPlane, CutFractionIsExactInThePlane) {
  for (const Vec<2>& m : normals2) {
    for (int i = 0; i <= 40; ++i) EXPECT_NEAR(cut_fraction(m, i / 40.0), by_corners(m, i / 40.0), 1e-14);
  }
}

TEST(PhysicsPlane, PlanesAlongFacesCutSlabs) {
  EXPECT_NEAR(cut_fraction(Vec<3>{0, 0, 1}, 0.3), 0.3, 1e-15);
  EXPECT_NEAR(cut_fraction(Vec<2>{1, 0}, 0.8), 0.8, 1e-15);
  EXPECT_NEAR(cut_fraction(Vec<3>{0, 0.5, 0.5}, 0.25), 0.125, 1e-15);  // a wedge
}

TEST(PhysicsPlane, NormalsNeedNotBeNormalised) {
  const Vec<3> m{0.2, 0.3, 0.5};
  EXPECT_NEAR(cut_fraction(Vec<3>{0.8, 1.2, 2.0}, 4 * 0.4), cut_fraction(m, 0.4), 1e-15);
}

TEST(PhysicsPlane, SlantedNormalsTendToStraightOnes) {
  for (const double tiny : {1e-3, 1e-6, 1e-9, 1e-12, 1e-300}) {
    for (const double alpha : {0.1, 0.25, 0.5, 0.75, 0.9}) {
      EXPECT_NEAR(cut_fraction(Vec<3>{tiny, 0.25, 0.75}, alpha), cut_fraction(Vec<2>{0.25, 0.75}, alpha),
                  3 * tiny + 1e-9);
    }
  }
}

TEST(PhysicsPlane, LiquidAndGasChangePlaces) {
  for (const Vec<3>& m : normals3) {
    for (int i = 0; i <= 20; ++i) EXPECT_NEAR(cut_fraction(m, i / 20.0) + cut_fraction(m, 1 - i / 20.0), 1, 1e-14);
  }
}

TEST(PhysicsPlane, OrderOfTheAxesDoesNotMatter) {
  for (const Vec<3>& m : normals3) {
    for (const double alpha : {0.05, 0.2, 0.41, 0.77}) {
      EXPECT_NEAR(cut_fraction(m, alpha), cut_fraction(Vec<3>{m[2], m[0], m[1]}, alpha), 1e-15);
      EXPECT_NEAR(cut_fraction(m, alpha), cut_fraction(Vec<3>{m[1], m[0], m[2]}, alpha), 1e-15);
    }
  }
}

TEST(PhysicsPlane, FractionGrowsWithTheOffset) {
  for (const Vec<3>& m : normals3) {
    double last = 0;
    for (int i = 1; i <= 1000; ++i) {
      const double now = cut_fraction(m, i / 1000.0);
      EXPECT_GT(now, last);
      last = now;
    }
    EXPECT_EQ(last, 1);
  }
}

template <int Dim>
void expect_inverse(const Vec<Dim>& m) {
  for (const double f : {1e-5, 1e-3, 0.1, 0.3, 0.5, 0.7, 0.99, 1 - 1e-5}) {
    EXPECT_NEAR(cut_fraction(m, plane_offset(m, f)), f, 1e-13);
  }
}

TEST(PhysicsPlane, OffsetIsTheInverseOfTheFraction) {
  for (const Vec<3>& m : normals3) expect_inverse(m);
  for (const Vec<2>& m : normals2) expect_inverse(m);
  expect_inverse(Vec<2>{0, 1});
  expect_inverse(Vec<3>{1e-7, 0.5, 0.5});
  expect_inverse(Vec<3>{0, 1e-5, 1 - 1e-5});
}

}  // namespace
}  // namespace quicksand
