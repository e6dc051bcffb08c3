// Redistribution of a slab, disc or ball of density 1 + e in the void: exact solutions of -lap H = phi_tilde - 1 with
// H = H' = 0 at the final radius R1.
//   slab of half-width R0:  R1 = R0 (1 + e),        H(0) = e (1 + e) R0^2 / 2
//   disc:                   R1 = R0 (1 + e)^(1/2),  H(0) = (R0^2 / 4) (1 + e) ln(1 + e)
//   ball:                   R1 = R0 (1 + e)^(1/3),  H(0) = (R0^2 / 2) [(1 + e) - (1 + e)^(2/3)]
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "solvers/obstacle.hpp"
#include "support/figures.hpp"
#include "support/grids.hpp"
#include "unit/solvers_problems.hpp"

namespace quicksand {
namespace {

using problems::cell_laplacian;
using problems::uniform_axis;

constexpr double start_radius = 0.25;

struct Exact {
  double radius;
  double centre;
};
Exact slab(double e) { return {start_radius * (1 + e), e * (1 + e) * start_radius * start_radius / 2}; }
Exact disc(double e) {
  return {start_radius * std::sqrt(1 + e), start_radius * start_radius / 4 * (1 + e) * std::log(1 + e)};
}
Exact ball(double e) {
  return {start_radius * std::cbrt(1 + e), start_radius * start_radius / 2 * (1 + e - std::pow(1 + e, 2.0 / 3))};
}

struct Errors {
  double radius;  ///< of the cells with H > 0, by their volume, relative
  double centre;  ///< of H in the first cell, relative
};

/// Share of a cell within start_radius of the origin, by subsampling. Axes of one cell (slab) don't count.
template <int Dim>
double filled_share(const Grid<Dim>& grid, const Index<Dim>& i) {
  constexpr int samples = Dim == 2 ? 32 : 10;
  int all = 1;
  for (int d = 0; d < Dim; ++d) all *= samples;
  int within = 0;
  for (int k = 0; k < all; ++k) {
    double squared = 0;
    for (int d = 0, rest = k; d < Dim; ++d, rest /= samples) {
      if (grid.owned_cells()[d] == 1) continue;
      const double x = grid.face_position(d, i[d]) + grid.width_1d(d, i[d]) * (rest % samples + 0.5) / samples;
      squared += x * x;
    }
    within += squared < start_radius * start_radius ? 1 : 0;
  }
  return static_cast<double>(within) / all;
}

/// \param radius_of  volume of the cells with H > 0 -> radius
template <int Dim, class RadiusOf>
Errors redistribute(const Grid<Dim>& grid, double e, const Exact& exact, RadiusOf&& radius_of) {
  constexpr double tolerance = 1e-10;
  const Layout<Dim>& layout = grid.layout();
  const auto matrix = cell_laplacian(grid, [](const Index<Dim>&) { return true; });
  CellField b(layout), H(layout), moved(layout);
  for_each<Cell>(layout, grid.cells(),
                 [&](Cell c, const Index<Dim>& i) { b[c] = ((1 + e) * filled_share(grid, i) - 1) * grid.volume(c); });
  ObstacleOptions options;
  options.tolerance = tolerance;
  solve_obstacle(matrix, b, testing::volumes(grid), H, options);

  matrix.apply(H, moved);
  double filled = 0;
  double largest_fraction = 0;
  double before = 0;
  double after = 0;
  for_each_coloured<Cell>(layout, grid.cells(), [&](Cell c, const Index<Dim>&) {
    const double fraction = 1 + (b[c] - moved[c]) / grid.volume(c);
    EXPECT_GE(H[c], 0);
    EXPECT_GE(fraction, -tolerance);
    if (H[c] > 0) {
      EXPECT_NEAR(fraction, 1, tolerance);
    }
    largest_fraction = std::fmax(largest_fraction, fraction);
    filled += H[c] > 0 ? grid.volume(c) : 0.0;
    before += b[c] + grid.volume(c);
    after += fraction * grid.volume(c);
  });
  EXPECT_LE(largest_fraction, 1 + tolerance);
  EXPECT_NEAR(after, before, 1e-13 * before);
  const Errors errors{std::abs(radius_of(filled) / exact.radius - 1),
                      std::abs(H[grid.cell(Index<Dim>{})] / exact.centre - 1)};
  return errors;
}

/// First order at least: the errors stay below bounds that halve with the cells. The radius jumps from cell to cell and
/// can't do better.
void expect_first_order(const std::string& what, int cells, const std::vector<Errors>& errors, double centre_bound,
                        double radius_bound) {
  double scale = 1;
  for (const Errors& e : errors) {
    const std::string with_cells = "excess of a " + what + ", " + std::to_string(cells) + " cells";
    testing::expect_at_most({with_cells, "relative error of H in the middle", "exact solution"}, e.centre,
                            centre_bound * scale);
    testing::expect_at_most({with_cells, "relative error of the radius", "exact solution"}, e.radius,
                            radius_bound * scale);
    scale /= 2;
    cells *= 2;
  }
}

TEST(ObstacleConvergence, Slab) {
  std::vector<Errors> errors;
  for (const int n : {21, 42, 84, 168}) {
    const Grid<2> grid({uniform_axis(1), uniform_axis(n, 0, 0.5)}, Geometry::planar);
    errors.push_back(redistribute(grid, 0.3, slab(0.3), [](double volume) { return volume; }));
  }
  expect_first_order("slab", 21, errors, 0.02, 0.1);
}

TEST(ObstacleConvergence, Disc) {
  std::vector<Errors> errors;
  for (const int n : {16, 32, 64, 128}) {
    const Grid<2> grid({uniform_axis(n, 0, 0.5), uniform_axis(n, 0, 0.5)}, Geometry::planar);
    errors.push_back(redistribute(grid, 0.2, disc(0.2), [](double volume) { return std::sqrt(4 * volume / M_PI); }));
  }
  expect_first_order("disc", 16, errors, 0.005, 0.06);
  EXPECT_LT(errors[1].centre, 0.01);
}

TEST(ObstacleConvergence, AxisymmetricBall) {
  std::vector<Errors> errors;
  for (const int n : {16, 32, 64, 128}) {
    const Grid<2> grid({uniform_axis(n, 0, 0.5), uniform_axis(n, 0, 0.5)}, Geometry::axisymmetric);
    errors.push_back(redistribute(grid, 0.2, ball(0.2), [](double volume) { return std::cbrt(3 * volume); }));
  }
  expect_first_order("ball", 16, errors, 0.005, 0.06);
  EXPECT_LT(errors[1].centre, 0.01);
}

TEST(ObstacleConvergence, BallInSpace) {
  std::vector<Errors> errors;
  for (const int n : {8, 16, 32}) {
    const std::vector<double> axis = uniform_axis(n, 0, 0.5);
    const Grid<3> grid({axis, axis, axis}, Geometry::cartesian);
    errors.push_back(redistribute(grid, 0.2, ball(0.2), [](double volume) { return std::cbrt(6 * volume / M_PI); }));
  }
  expect_first_order("ball in space", 8, errors, 0.12, 0.08);
  EXPECT_LT(errors[2].centre, 0.01);
}

}  // namespace
}  // namespace quicksand
