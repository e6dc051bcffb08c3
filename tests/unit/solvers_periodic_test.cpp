// Stencil matrices on grids with periodic axes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "solvers/linear_solver.hpp"
#include "solvers/multigrid.hpp"
#include "solvers/obstacle.hpp"
#include "support/grids.hpp"
#include "unit/solvers_problems.hpp"

namespace quicksand {
namespace {

using problems::cell_laplacian;
using problems::node_laplacian;
using problems::rough_field;
using problems::uniform_axis;

const auto everywhere = [](const auto&) { return true; };
const auto but_one = [](const auto& i) { return i[0] != 0 || i[1] != 0; };

Grid<2> plane(int n, int m) { return Grid<2>({uniform_axis(n), uniform_axis(m)}, Geometry::planar); }
Grid<2> ring(int n, int m) { return plane(n, m).with_periodic({{true, false}}); }
Grid<2> torus(int n, int m) { return plane(n, m).with_periodic({{true, true}}); }
Grid<3> torus(int n, int m, int k) {
  const Grid<3> box({uniform_axis(n), uniform_axis(m), uniform_axis(k)}, Geometry::cartesian);
  return box.with_periodic({{true, true, true}});
}

/// Checked with two rough vectors and the constant one.
template <int Dim, class At>
void expect_symmetric_with_zero_row_sums(const StencilMatrix<Dim, At>& matrix) {
  Field<At> a = rough_field(matrix);
  Field<At> b(matrix.layout), Aa(matrix.layout), Ab(matrix.layout), one(matrix.layout, 1.0), zero(matrix.layout);
  for_each<At>(matrix.layout, matrix.box, [&](At p) { b[p] = std::cos(10 * a[p]); });
  matrix.apply(a, Aa);
  matrix.apply(b, Ab);
  matrix.apply(one, zero);
  EXPECT_NEAR(dot<At>(matrix.layout, matrix.box, a, Ab), dot<At>(matrix.layout, matrix.box, b, Aa), 1e-11);
  EXPECT_GE(dot<At>(matrix.layout, matrix.box, a, Aa), 0);
  for_each<At>(matrix.layout, matrix.box, [&](At p) {
    EXPECT_NEAR(zero[p], 0, 1e-11);
    EXPECT_NEAR(matrix.row_sum(p), 0, 1e-11);
  });
}

TEST(SolversPeriodic, MatricesAreSymmetricAcrossTheEnds) {
  for (const int n : {1, 2, 3, 8}) {
    expect_symmetric_with_zero_row_sums(cell_laplacian(ring(n, 5), everywhere));
    expect_symmetric_with_zero_row_sums(node_laplacian(ring(n, 5), everywhere));
    expect_symmetric_with_zero_row_sums(cell_laplacian(torus(4, n), everywhere));
    expect_symmetric_with_zero_row_sums(node_laplacian(torus(4, n), everywhere));
    expect_symmetric_with_zero_row_sums(cell_laplacian(torus(3, n, 4), everywhere));
    expect_symmetric_with_zero_row_sums(node_laplacian(torus(3, n, 4), everywhere));
    expect_symmetric_with_zero_row_sums(node_laplacian(torus(n, 3, 1), everywhere));
    expect_symmetric_with_zero_row_sums(star_part(node_laplacian(torus(3, n, 4), everywhere)));
  }
}

/// A product on a uniform ring does not know where the ring begins.
template <int Dim, class At>
void expect_products_shift(const StencilMatrix<Dim, At>& matrix, const Index<Dim>& shift) {
  Field<At> x = rough_field(matrix);
  Field<At> there(matrix.layout), Ax(matrix.layout), At_(matrix.layout);
  const auto shifted = [&](Index<Dim> i) {
    for (int d = 0; d < Dim; ++d) i[d] += shift[d];
    return At{matrix.layout.flat(matrix.layout.image(i))};
  };
  for_each<At>(matrix.layout, matrix.box, [&](At p, const Index<Dim>& i) { there[shifted(i)] = x[p]; });
  matrix.apply(x, Ax);
  matrix.apply(there, At_);
  for_each<At>(matrix.layout, matrix.box,
               [&](At p, const Index<Dim>& i) { EXPECT_NEAR(At_[shifted(i)], Ax[p], 1e-11); });
}

TEST(SolversPeriodic, ProductsShiftWithTheirOperands) {
  expect_products_shift(cell_laplacian(ring(7, 5), everywhere), Index<2>{{3, 0}});
  expect_products_shift(node_laplacian(ring(7, 5), everywhere), Index<2>{{3, 0}});
  expect_products_shift(node_laplacian(torus(5, 4, 3), everywhere), Index<3>{{3, 1, 2}});
  expect_products_shift(star_part(node_laplacian(torus(5, 4, 3), everywhere)), Index<3>{{3, 1, 2}});
}

TEST(SolversPeriodic, ABoxThatReachesAnEndSpansTheAxis) {
  const Layout<2> layout(Index<2>{{8, 9}}, {{true, false}});
  const Box<2> all{Index<2>{}, layout.cells()};
  const auto around = [&](int x, int z) {
    return bounding_box<Cell>(layout, all, [&](Cell c) { return c == Cell{layout.flat(Index<2>{{x, z}})}; });
  };
  EXPECT_EQ(around(3, 0), (Box<2>{Index<2>{{3, 0}}, Index<2>{{4, 1}}}));
  EXPECT_EQ(around(0, 4), (Box<2>{Index<2>{{0, 4}}, Index<2>{{8, 5}}}));
  EXPECT_EQ(around(7, 4), (Box<2>{Index<2>{{0, 4}}, Index<2>{{8, 5}}}));
  EXPECT_TRUE(bounding_box<Cell>(layout, all, [](Cell) { return false; }).empty());
}

template <int Dim, class At>
void expect_solved(StencilMatrix<Dim, At> matrix, int most_iterations, Method method = Method::pfmg) {
  Field<At> b = rough_field(matrix);
  Field<At> x(matrix.layout);
  SolveOptions options;
  options.method = method;
  const SolveReport report = solve(matrix, b, x, options);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.method, name(method));
  EXPECT_LE(report.iterations, most_iterations);
}

TEST(SolversPeriodic, CholeskyFactorsGoRoundTheAxes) {
  for (const int n : {1, 2, 3, 17}) {
    expect_solved(cell_laplacian(ring(n, 9), but_one), 2, Method::direct);
    expect_solved(node_laplacian(torus(6, n), but_one), 2, Method::direct);
    expect_solved(node_laplacian(torus(4, n, 5), everywhere), 2, Method::direct);
  }
}

TEST(SolversPeriodic, MultigridGoesRoundAxesOfManyTwos) {
  // Not periodic: 10 to 13 iterations with PFMG, 7 with SMG.
  for (const int n : {96, 80, 128}) {
    expect_solved(cell_laplacian(ring(n, 96), everywhere), 15);
    expect_solved(node_laplacian(ring(n, 96), everywhere), 15);
    expect_solved(cell_laplacian(torus(n, 96), but_one), 15);
    expect_solved(node_laplacian(torus(n, 96), but_one), 15);
  }
  expect_solved(node_laplacian(torus(128, 96), but_one), 20, Method::star_pfmg);
  expect_solved(cell_laplacian(ring(64, 96), everywhere), 8, Method::smg);
  expect_solved(node_laplacian(torus(64, 32), but_one), 8, Method::smg);
  expect_solved(cell_laplacian(torus(32, 24, 16), everywhere), 15);
  expect_solved(node_laplacian(torus(32, 24, 16), everywhere), 40, Method::star_pfmg);
}

TEST(SolversPeriodic, OtherAxesAreCutOpenInThePreconditioner) {
  expect_solved(cell_laplacian(ring(97, 96), everywhere), 60);
  expect_solved(node_laplacian(torus(90, 96), but_one), 60);
  expect_solved(cell_laplacian(ring(96, 96), everywhere), 60, Method::smg);
}

/// A preconditioner of CG must be symmetric and positive definite.
template <int Dim, class At>
void expect_symmetric_positive_cycle(const StencilMatrix<Dim, At>& matrix) {
  for (const MultigridKind kind : {MultigridKind::pfmg, MultigridKind::smg}) {
    Multigrid<Dim, At> multigrid(matrix, kind);
    const Field<At> a = rough_field(matrix);
    Field<At> b(matrix.layout), Ma(matrix.layout), Mb(matrix.layout);
    for_each<At>(matrix.layout, matrix.box, [&](At p) { b[p] = std::cos(10 * a[p]); });
    multigrid.cycle(a, Ma);
    multigrid.cycle(b, Mb);
    const auto product = [&](const Field<At>& x, const Field<At>& y) {
      return dot<At>(matrix.layout, matrix.box, x, y);
    };
    EXPECT_GT(product(b, Mb), 0);
    EXPECT_NEAR(product(b, Ma), product(a, Mb), 1e-10 * product(b, Mb));
  }
}

TEST(SolversPeriodic, CyclesAreSymmetricAndPositive) {
  for (const int n : {2, 3, 6, 15, 16}) {
    for (const int m : {1, 2, 3, 16, 17}) {
      SCOPED_TRACE(std::to_string(n) + " x " + std::to_string(m));
      expect_symmetric_positive_cycle(cell_laplacian(ring(n, m), but_one));
      expect_symmetric_positive_cycle(node_laplacian(ring(n, m), but_one));
      expect_symmetric_positive_cycle(cell_laplacian(torus(n, m), but_one));
      expect_symmetric_positive_cycle(node_laplacian(torus(n, m), but_one));
    }
    expect_symmetric_positive_cycle(cell_laplacian(torus(n, 3, 4), but_one));
    expect_symmetric_positive_cycle(node_laplacian(torus(n, 3, 4), but_one));
  }
}

TEST(SolversPeriodic, ExcessSpreadsAcrossTheEnds) {
  for (const int n : {40, 41}) {
    const Grid<2> grid = torus(n, 24);
    const auto matrix = cell_laplacian(grid, everywhere);
    const auto solved = [&](int shift) {
      CellField b(grid.layout()), H(grid.layout());
      for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, Index<2> i) {
        i[0] -= shift;
        i = grid.layout().image(i);
        const double distance = std::hypot(i[0] - 20, i[1] - 12);
        b[c] = (distance < 4 ? 0.8 : distance < 6 ? -0.05 : -0.4) * grid.volume(c);
      });
      const ObstacleReport report = solve_obstacle(matrix, b, testing::volumes(grid), H);
      EXPECT_LE(report.violation, 1e-9);
      EXPECT_LE(report.iterations, 12);
      return H;
    };
    const CellField middle = solved(0);
    const CellField ends = solved(19);
    const double height = maximum<Cell>(grid.layout(), grid.cells(), 0, [&](Cell c) { return middle[c]; });
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, Index<2> i) {
      i[0] += 19;
      EXPECT_NEAR(ends[Cell{grid.layout().flat(grid.layout().image(i))}], middle[c], 1e-6 * height);
    });
  }
}

}  // namespace
}  // namespace quicksand
