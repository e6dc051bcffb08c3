#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "core/errors.hpp"
#include "solvers/conjugate_gradients.hpp"
#include "solvers/obstacle.hpp"
#include "support/grids.hpp"
#include "unit/solvers_problems.hpp"

namespace quicksand {
namespace {

using problems::cell_laplacian;
using problems::graded_axis;
using problems::uniform_axis;

const auto everywhere = [](const auto&) { return true; };

/// An obstacle problem on a whole grid, from the excess fraction phi_tilde - limit in every cell.
template <int Dim>
struct Problem {
  Grid<Dim> grid;
  StencilMatrix<Dim, Cell> matrix;
  CellField b;
  CellField H;

  /// excess: callable (Index) -> fraction, called for the cells in order
  template <class Excess>
  Problem(Grid<Dim> grid_in, Excess&& excess)
      : grid(std::move(grid_in)), matrix(cell_laplacian(grid, everywhere)), b(grid.layout()), H(grid.layout()) {
    const Box<Dim> box = grid.cells();
    const Rows<Dim> rows(grid.layout(), box);
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      Index<Dim> index = grid.layout().multi(rows.start(r));
      for (int i = 0; i < rows.length; ++i, ++index[0]) {
        const Cell c{rows.start(r) + i};
        b[c] = excess(index) * grid.volume(c);
      }
    }
  }

  /// H = 0 on the faces of the high side of the last axis.
  void open_top() {
    constexpr int d = Dim - 1;
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
      if (i[d] == grid.owned_cells()[d] - 1) {
        matrix.diagonal[c] += 2 * grid.area(d, i) / grid.width_1d(d, i[d]);
      }
    });
  }

  ObstacleReport solve(double tolerance = 1e-9) {
    ObstacleOptions options;
    options.tolerance = tolerance;
    return solve_obstacle(matrix, b, testing::volumes(grid), H, options);
  }

  /// 1/2 H^T A H - b^T H of any field.
  double energy(CellField field) const {
    CellField product(grid.layout());
    matrix.apply(field, product);
    return dot<Cell>(grid.layout(), grid.cells(), field, product) / 2 -
           dot<Cell>(grid.layout(), grid.cells(), b, field);
  }

  void expect_complementary(double tolerance) {
    CellField r(grid.layout());
    matrix.residual(b, H, r);
    const double worst = maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) {
      EXPECT_GE(H[c], 0);
      const double error = r[c] / grid.volume(c);
      return H[c] > 0 ? std::abs(error) : error;
    });
    EXPECT_LE(worst, tolerance);
  }
};

Grid<2> unit_square(int n) { return Grid<2>({uniform_axis(n), uniform_axis(n)}, Geometry::planar); }

/// A pool: full to round-off below a surface layer with room, void above, and an impact on the surface.
auto pool(int n, double noise) {
  return [=, random = std::mt19937(1)](const Index<2>& i) mutable {
    const double u = static_cast<double>(random()) / 4294967295.0;
    const int surface = (3 * n) / 5 + static_cast<int>(0.1 * n * std::sin(2 * M_PI * i[0] / n));
    if (i[1] > surface) return -1.0;
    if (i[1] == surface) return std::abs(i[0] - n / 2) < n / 16 ? 0.1 * u : -0.01 - 0.99 * u;
    return noise * (2 * u - 1);
  };
}

auto disc(int n, double density) {
  return [=](const Index<2>& i) {
    return std::hypot(i[0] + 0.5 - n / 2.0, i[1] + 0.5 - n / 2.0) < n / 4.0 ? density - 1 : -1.0;
  };
}

/// Cells with excess, without room and with room, at random.
auto random_cells() {
  return [random = std::mt19937(7)](const Index<2>&) mutable {
    const double kind = static_cast<double>(random()) / 4294967295.0;
    const double u = static_cast<double>(random()) / 4294967295.0;
    return kind < 0.4 ? 0.1 * u : kind < 0.8 ? 0.0 : -0.4 * u;
  };
}

TEST(Obstacle, NothingToDoWithoutExcess) {
  Problem<2> problem(unit_square(32), [](const Index<2>& i) { return i[1] < 16 ? 2e-10 : -1.0; });
  problem.H.fill(1);
  const ObstacleReport report = problem.solve();
  EXPECT_TRUE(report.trivial);
  EXPECT_EQ(report.iterations, 0);
  for_each<Cell>(problem.grid.layout(), problem.grid.cells(), [&](Cell c) { EXPECT_EQ(problem.H[c], 0); });
}

TEST(Obstacle, PoolsTakeAboutOneLinearSolve) {
  for (const int n : {32, 64, 128}) {
    for (const double noise : {0.0, 1e-9, 1e-7}) {
      Problem<2> problem(unit_square(n), pool(n, noise));
      const ObstacleReport report = problem.solve();
      EXPECT_FALSE(report.trivial);
      EXPECT_LE(report.iterations, 4);
      EXPECT_LE(report.cycles, 18);
      EXPECT_GT(report.active, n * n / 3);
      problem.expect_complementary(1e-9);
    }
  }
}

TEST(Obstacle, FrontsThatMoveManyCells) {
  for (const double density : {1.2, 2.0}) {
    Problem<2> problem(unit_square(128), disc(128, density));
    const ObstacleReport report = problem.solve();
    EXPECT_LE(report.iterations, 12);
    EXPECT_LE(report.cycles, 40);
    problem.expect_complementary(1e-9);
  }
}

TEST(Obstacle, RoughExcessAndRoom) {
  Problem<2> problem(unit_square(96), random_cells());
  const ObstacleReport report = problem.solve();
  EXPECT_LE(report.iterations, 15);
  problem.expect_complementary(1e-9);
}

TEST(Obstacle, GradedAndAxisymmetricGrids) {
  for (const Geometry geometry : {Geometry::planar, Geometry::axisymmetric}) {
    Problem<2> problem(Grid<2>({graded_axis(70, 40), graded_axis(110, 40)}, geometry), [](const Index<2>& i) {
      return i[0] + i[1] < 60 ? 0.2 : i[0] + i[1] < 90 ? 0.0 : -1.0;
    });
    const ObstacleReport report = problem.solve();
    EXPECT_LE(report.iterations, 15);
    problem.expect_complementary(1e-9);
  }
}

TEST(Obstacle, ThinGridsInSpace) {
  Problem<3> problem(Grid<3>({uniform_axis(40), uniform_axis(1), uniform_axis(40)}, Geometry::cartesian),
                     [](const Index<3>& i) { return std::hypot(i[0] - 20, i[2] - 15) < 8 ? 0.5 : -1.0; });
  problem.solve();
  problem.expect_complementary(1e-9);
}

TEST(Obstacle, SolutionHasTheLeastEnergy) {
  Problem<2> problem(unit_square(24), random_cells());
  problem.solve(1e-12);
  const double least = problem.energy(problem.H);
  EXPECT_LT(least, 0);
  std::mt19937 random(11);
  for (int trial = 0; trial < 50; ++trial) {
    CellField other = problem.H;
    for (int k = 0; k < 20; ++k) {
      const Index<2> i{{static_cast<int>(random() % 24), static_cast<int>(random() % 24)}};
      const double change = (static_cast<double>(random()) / 4294967295.0 - 0.5) * 1e-4;
      double& value = other[problem.grid.cell(i)];
      value = std::fmax(value + change, 0.0);
    }
    EXPECT_GE(problem.energy(other), least);
  }
}

TEST(Obstacle, AnyGuessLeadsToTheSameSolution) {
  Problem<2> cold(unit_square(64), disc(64, 1.2));
  cold.solve(1e-11);
  Problem<2> warm(unit_square(64), disc(64, 1.2));
  warm.H = cold.H;
  EXPECT_LE(warm.solve(1e-10).cycles, 2);
  Problem<2> wrong(unit_square(64), disc(64, 1.2));
  std::mt19937 random(5);
  for (std::ptrdiff_t n = 0; n < wrong.grid.layout().size(); ++n) {
    wrong.H[Cell{n}] = static_cast<double>(random()) / 4294967295.0 - 0.3;
  }
  wrong.solve(1e-11);
  for_each<Cell>(cold.grid.layout(), cold.grid.cells(),
                 [&](Cell c) { EXPECT_NEAR(wrong.H[c], cold.H[c], 1e-9 * 3.4e-3 * 1e3); });
}

TEST(Obstacle, WhatMovesNothingIsZero) {
  // A full pool at rest, of which a past impact left some H, and a drop above it that gives volume.
  constexpr int n = 32;
  const auto at_rest = [](const Index<2>& i) { return i[1] < n / 4; };
  Problem<2> problem(unit_square(n), [&](const Index<2>& i) {
    const bool in_drop = std::hypot(i[0] - n / 2, i[1] - (3 * n) / 4) < 4;
    return in_drop ? 0.1 : at_rest(i) ? 0.0 : -1.0;
  });
  for (const double left : {1e-3, 1e-15, 1e-30, 1e-310}) {
    for_each<Cell>(problem.grid.layout(), problem.grid.cells(), [&](Cell c, const Index<2>& i) {
      if (at_rest(i)) problem.H[c] = left * (1 + i[0]);
    });
    for (int step = 0; step < 25; ++step) problem.solve();
    problem.expect_complementary(1e-9);
    for_each<Cell>(problem.grid.layout(), problem.grid.cells(), [&](Cell c, const Index<2>& i) {
      const double moved = problem.matrix.diagonal[c] * problem.H[c] / problem.grid.volume(i);
      EXPECT_TRUE(moved == 0 || moved > 1e-17) << moved;
      EXPECT_TRUE(moved <= 1e-9 || !at_rest(i)) << moved;
    });
  }
}

TEST(Obstacle, VolumeIsConservedInClosedBoxes) {
  Problem<2> problem(unit_square(64), pool(64, 1e-9));
  problem.solve();
  CellField moved(problem.grid.layout());
  problem.matrix.apply(problem.H, moved);
  const double sum_moved = sum<Cell>(problem.grid.layout(), problem.grid.cells(), [&](Cell c) { return moved[c]; });
  EXPECT_NEAR(sum_moved, 0, 1e-16);
}

TEST(Obstacle, FullBoxLetsVolumeOutAtTheOpenSide) {
  Problem<2> problem(unit_square(48), [](const Index<2>& i) { return i[1] == 3 && i[0] == 20 ? 0.05 : 0.0; });
  problem.open_top();
  const ObstacleReport report = problem.solve();
  EXPECT_EQ(report.active, 48 * 48);
  problem.expect_complementary(1e-9);
}

TEST(Obstacle, OverfullClosedBoxHasNoSolution) {
  Problem<2> problem(unit_square(16), [](const Index<2>& i) { return i[1] == 15 && i[0] == 2 ? -0.1 : 0.01; });
  try {
    problem.solve();
    FAIL() << "no exception";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("overfull"), std::string::npos);
  }
}

TEST(Obstacle, ClosedBoxesWithLittleOrJustEnoughRoom) {
  for (const int n : {16, 64}) {
    // One cell has more room than another has excess.
    Problem<2> enough(unit_square(n), [](const Index<2>& i) {
      return i[1] == 3 && i[0] == 2 ? 0.05 : i[1] == 10 && i[0] == 12 ? -0.06 : -1e-4;
    });
    enough.solve();
    enough.expect_complementary(1e-9);
    // The excess just fits: H is positive nearly everywhere, and zero somewhere.
    Problem<2> just(unit_square(n), [](const Index<2>& i) {
      return i[1] == 3 && i[0] == 2 ? 0.05 : i[1] == 10 && i[0] == 12 ? -0.05 : 0.0;
    });
    just.solve();
    just.expect_complementary(1e-9);
    const double least = -maximum<Cell>(just.grid.layout(), just.grid.cells(), -1, [&](Cell c) { return -just.H[c]; });
    EXPECT_EQ(least, 0);
  }
}

TEST(Obstacle, SaysWhenItDoesNotConverge) {
  Problem<2> problem(unit_square(64), disc(64, 2));
  ObstacleOptions options;
  options.max_iterations = 1;
  EXPECT_THROW(solve_obstacle(problem.matrix, problem.b, testing::volumes(problem.grid), problem.H, options),
               NumericalError);
  problem.b[problem.grid.cell(Index<2>{{5, 5}})] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(problem.solve(), NumericalError);
}

}  // namespace
}  // namespace quicksand
