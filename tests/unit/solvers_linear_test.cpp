#include "solvers/linear_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/errors.hpp"
#include "solvers/multigrid.hpp"
#include "support/grids.hpp"
#include "unit/solvers_problems.hpp"

namespace quicksand {
namespace {

using problems::cell_laplacian;
using problems::graded_axis;
using problems::node_laplacian;
using problems::rough_field;
using problems::uniform_axis;

const auto everywhere = [](const auto&) { return true; };
/// Water below, void above: the usual shape of a liquid domain.
template <int Dim>
auto lower_part(const Grid<Dim>& grid) {
  const int surface = 2 * grid.owned_cells()[Dim - 1] / 3;
  return [surface](const Index<Dim>& i) { return i[Dim - 1] < surface + i[0] % 2; };
}

template <int Dim, class At>
double true_residual(const StencilMatrix<Dim, At>& matrix, const Field<At>& b, Field<At>& x) {
  Field<At> r(matrix.layout);
  matrix.residual(b, x, r);
  return std::sqrt(dot<At>(matrix.layout, matrix.box, r, r) / dot<At>(matrix.layout, matrix.box, b, b));
}

/// Solves for a rough right-hand side to 1e-8 from zero.
template <int Dim, class At>
void expect_solved(StencilMatrix<Dim, At> matrix, Method expected, int most_iterations) {
  Field<At> b = rough_field(matrix);
  Field<At> x(matrix.layout);
  const SolveReport report = solve(matrix, b, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.method, name(expected));
  EXPECT_LE(report.iterations, most_iterations);
  EXPECT_LE(report.residual, 1e-8);
  EXPECT_NEAR(report.residual, true_residual(matrix, b, x), 1e-12);
}

TEST(LinearSolver, FivePointsOnUniformGrids) {
  const Grid<2> square({uniform_axis(144), uniform_axis(144)}, Geometry::planar);
  expect_solved(cell_laplacian(square, lower_part(square)), Method::pfmg, 12);
  expect_solved(cell_laplacian(square, lower_part(square), true), Method::pfmg, 12);
  const Grid<2> flat({uniform_axis(96), uniform_axis(144, 0, 30)}, Geometry::planar);
  expect_solved(cell_laplacian(flat, lower_part(flat)), Method::pfmg, 16);
  const Grid<2> tube({uniform_axis(96), uniform_axis(144)}, Geometry::axisymmetric);
  expect_solved(cell_laplacian(tube, lower_part(tube)), Method::pfmg, 16);
}

TEST(LinearSolver, FivePointsOnGradedGrids) {
  const Grid<2> one_axis({uniform_axis(96), graded_axis(144, 30)}, Geometry::planar);
  expect_solved(cell_laplacian(one_axis, lower_part(one_axis)), Method::pfmg, 25);
  const Grid<2> both({graded_axis(90, 30), graded_axis(150, 30)}, Geometry::planar);
  expect_solved(cell_laplacian(both, lower_part(both)), Method::smg, 8);
}

TEST(LinearSolver, NinePoints) {
  const Grid<2> square({uniform_axis(144), uniform_axis(144)}, Geometry::planar);
  expect_solved(node_laplacian(square, lower_part(square)), Method::pfmg, 16);
  const Grid<2> flat({uniform_axis(96), uniform_axis(144, 0, 30)}, Geometry::planar);
  expect_solved(node_laplacian(flat, lower_part(flat)), Method::star_pfmg, 24);
  const Grid<2> graded({uniform_axis(96), graded_axis(144, 30)}, Geometry::planar);
  expect_solved(node_laplacian(graded, lower_part(graded)), Method::star_pfmg, 30);
  const Grid<2> both({graded_axis(90, 30), graded_axis(150, 30)}, Geometry::planar);
  expect_solved(node_laplacian(both, lower_part(both)), Method::smg, 12);
}

TEST(LinearSolver, SevenAndTwentySevenPoints) {
  const Grid<3> grid({uniform_axis(20), uniform_axis(20), uniform_axis(24, 0, 1.2)}, Geometry::cartesian);
  expect_solved(cell_laplacian(grid, lower_part(grid)), Method::pfmg, 17);
  expect_solved(node_laplacian(grid, lower_part(grid)), pfmg_suits_27_points() ? Method::pfmg : Method::star_pfmg, 40);
}

TEST(LinearSolver, OneCellThick) {
  const Grid<3> slice({uniform_axis(96), uniform_axis(1), uniform_axis(144)}, Geometry::cartesian);
  expect_solved(cell_laplacian(slice, lower_part(slice)), Method::pfmg, 14);
  expect_solved(node_laplacian(slice, lower_part(slice)), pfmg_suits_27_points() ? Method::pfmg : Method::star_pfmg,
                70);
}

TEST(LinearSolver, SmallSystemsAndLinesAreFactorised) {
  const Grid<2> small({graded_axis(16, 20), graded_axis(48, 20)}, Geometry::planar);
  expect_solved(cell_laplacian(small, lower_part(small)), Method::direct, 2);
  expect_solved(node_laplacian(small, lower_part(small)), Method::direct, 2);
  const Grid<2> line({uniform_axis(1), uniform_axis(3000)}, Geometry::planar);
  expect_solved(cell_laplacian(line, lower_part(line)), Method::direct, 2);
  const Grid<2> point({uniform_axis(1), uniform_axis(1)}, Geometry::planar);
  auto matrix = cell_laplacian(point, everywhere);
  const Cell only = point.cell(Index<2>{});
  matrix.diagonal[only] = 4;
  CellField b(point.layout(), 2.0);
  CellField x(point.layout());
  EXPECT_TRUE(solve(matrix, b, x).converged);
  EXPECT_DOUBLE_EQ(x[only], 0.5);
}

TEST(LinearSolver, AllNeumannSystemsAreMadeConsistent) {
  for (const int n : {12, 80}) {
    const Grid<2> grid({uniform_axis(n), graded_axis(n, 2)}, Geometry::planar);
    auto matrix = cell_laplacian(grid, everywhere);
    CellField b = rough_field(matrix);
    CellField consistent = b;
    const double cells = static_cast<double>(matrix.box.size());
    const double mean = sum<Cell>(grid.layout(), matrix.box, [&](Cell c) { return b[c]; }) / cells;
    CellField x(grid.layout());
    const SolveReport report = solve(matrix, b, x);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 18);
    EXPECT_LE(solve(matrix, b, x).iterations, 1);
    for_each<Cell>(grid.layout(), matrix.box, [&](Cell c) { consistent[c] -= mean; });
    EXPECT_LT(testing::largest_difference(grid, b, consistent), 1e-14);
    EXPECT_LT(true_residual(matrix, consistent, x), 2e-8);
    EXPECT_NEAR(sum<Cell>(grid.layout(), matrix.box, [&](Cell c) { return x[c]; }) / cells, 0, 1e-12);
  }
}

TEST(LinearSolver, WarmStartSavesIterations) {
  const Grid<2> grid({uniform_axis(96), uniform_axis(96)}, Geometry::planar);
  auto matrix = cell_laplacian(grid, lower_part(grid));
  CellField b = rough_field(matrix);
  CellField x(grid.layout());
  const int cold = solve(matrix, b, x).iterations;
  EXPECT_EQ(solve(matrix, b, x).iterations, 0);
  for_each<Cell>(grid.layout(), matrix.box, [&](Cell c) { b[c] *= 1 + 1e-4 * b[c]; });
  EXPECT_LE(solve(matrix, b, x).iterations, cold - 3);
}

TEST(LinearSolver, ZeroRightHandSideGivesZero) {
  const Grid<2> grid({uniform_axis(96), uniform_axis(96)}, Geometry::planar);
  auto matrix = cell_laplacian(grid, lower_part(grid));
  CellField b(grid.layout());
  CellField x(grid.layout());
  const SolveReport report = solve(matrix, b, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.residual, 0);
}

TEST(LinearSolver, AKeptPreconditionerServesSeveralRightHandSides) {
  const Grid<2> grid({uniform_axis(96), uniform_axis(96)}, Geometry::planar);
  auto matrix = node_laplacian(grid, lower_part(grid));
  Preconditioner<2, Node> preconditioner(matrix);
  NodeField b = rough_field(matrix);
  for (int k = 0; k < 3; ++k) {
    NodeField x(grid.layout());
    EXPECT_TRUE(solve(matrix, preconditioner, b, x, Tolerance{}).converged);
    EXPECT_LT(true_residual(matrix, b, x), 1.1e-8);
    for_each<Node>(grid.layout(), matrix.box, [&](Node p) { b[p] = std::cos(5 * b[p]); });
  }
}

TEST(LinearSolver, SaysWhenItDoesNotConverge) {
  const Grid<2> grid({uniform_axis(96), uniform_axis(96)}, Geometry::planar);
  auto matrix = cell_laplacian(grid, lower_part(grid));
  CellField x(grid.layout());
  SolveOptions options;
  options.relative = 1e-13;
  options.max_iterations = 1;
  CellField b = rough_field(matrix);
  const SolveReport report = solve(matrix, b, x, options);
  EXPECT_FALSE(report.converged);
  EXPECT_NEAR(report.residual, true_residual(matrix, b, x), 1e-12);
  try {
    require_converged(report, "test problem");
    FAIL() << "no exception";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("test problem"), std::string::npos);
  }
}

TEST(LinearSolver, FallsBackWhenTheFirstChoiceFails) {
  const Grid<2> grid({graded_axis(48, 30), graded_axis(48, 30)}, Geometry::planar);
  auto matrix = cell_laplacian(grid, lower_part(grid));
  CellField x(grid.layout());
  SolveOptions options;
  options.method = Method::pfmg;
  options.max_iterations = 10;
  auto b = rough_field(matrix);
  const SolveReport report = solve(matrix, b, x, options);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.method, name(Method::smg));
}

TEST(LinearSolver, RefusesValuesThatAreNotFinite) {
  const Grid<2> grid({uniform_axis(48), uniform_axis(48)}, Geometry::planar);
  auto matrix = cell_laplacian(grid, lower_part(grid));
  CellField b = rough_field(matrix);
  CellField x(grid.layout());
  // A guess that is not finite is replaced by zero.
  x[grid.cell(Index<2>{{3, 3}})] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(solve(matrix, b, x).converged);
  b[grid.cell(Index<2>{{3, 3}})] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solve(matrix, b, x).converged);
}

TEST(ConjugateGradients, SolvesForVectorsOfFields) {
  const Grid<2> grid({uniform_axis(24), uniform_axis(24)}, Geometry::planar);
  const auto laplacian = cell_laplacian(grid, lower_part(grid));
  const Layout<2>& layout = grid.layout();
  // Two components coupled in every cell: [A + s, s; s, A + 2 s].
  const double s = 0.01;
  const auto apply = [&](CellVectors<2>& x, CellVectors<2>& y) {
    for (int d = 0; d < 2; ++d) {
      laplacian.apply(x[d], y[d]);
      for_each<Cell>(layout, grid.cells(), [&](Cell c) { y[d][c] += s * (x[0][c] + x[1][c] + d * x[1][c]); });
    }
  };
  Preconditioner<2, Cell> block(laplacian);
  const auto precondition = [&](const CellVectors<2>& r, CellVectors<2>& z) {
    for (int d = 0; d < 2; ++d) block(r[d], z[d]);
  };
  CellVectors<2> b(layout), x(layout), r(layout);
  b[0] = rough_field(laplacian);
  for_each<Cell>(layout, grid.cells(), [&](Cell c) { b[1][c] = std::cos(9 * b[0][c]); });
  const SolveReport report =
      conjugate_gradients<Cell>(layout, grid.cells(), apply, precondition, b, x, Tolerance{1e-10, 0, 100});
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 25);
  apply(x, r);
  combine<Cell>(layout, grid.cells(), r, b, [](double& ri, double bi) { ri -= bi; });
  EXPECT_LT(dot<Cell>(layout, grid.cells(), r, r), 1.1e-20 * dot<Cell>(layout, grid.cells(), b, b));
}

TEST(ConjugateGradients, NoticesOperatorsThatAreNotPositive) {
  const Layout<2> layout(Index<2>{{4, 4}});
  const Box<2> box{Index<2>{}, layout.cells()};
  CellField b(layout, 1.0);
  CellField x(layout);
  const auto negate = [&](const CellField& v, CellField& y) {
    for_each<Cell>(layout, box, [&](Cell c) { y[c] = -v[c]; });
  };
  const auto copy = [&](const CellField& v, CellField& y) {
    for_each<Cell>(layout, box, [&](Cell c) { y[c] = v[c]; });
  };
  const SolveReport report = conjugate_gradients<Cell>(layout, box, negate, copy, b, x, Tolerance{});
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.residual, 1);
}

}  // namespace
}  // namespace quicksand
