#include "solvers/multigrid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/threads.hpp"
#include "solvers/conjugate_gradients.hpp"
#include "unit/solvers_problems.hpp"

namespace quicksand {
namespace {

using problems::cell_laplacian;
using problems::graded_axis;
using problems::node_laplacian;
using problems::rough_field;
using problems::uniform_axis;

const auto all_but_one = [](const auto& i) { return i[0] > 0 || i[1] > 0; };

/// A preconditioner of CG must be symmetric and positive definite: checked with two rough vectors. One may have any
/// values in identity rows.
template <int Dim, class At>
void expect_symmetric_positive(const StencilMatrix<Dim, At>& matrix, MultigridKind kind) {
  const Layout<Dim>& layout = matrix.layout;
  Multigrid<Dim, At> multigrid(matrix, kind);
  const Field<At> a = rough_field(matrix);
  Field<At> b(layout), Ma(layout), Mb(layout);
  for_each<At>(layout, matrix.box, [&](At p) { b[p] = std::cos(10 * a[p]); });
  multigrid.cycle(a, Ma);
  multigrid.cycle(b, Mb);
  const double ab = dot<At>(layout, matrix.box, Ma, b);
  const double ba = dot<At>(layout, matrix.box, a, Mb);
  const double aa = dot<At>(layout, matrix.box, a, Ma);
  const double bb = dot<At>(layout, matrix.box, b, Mb);
  EXPECT_GT(aa, 0);
  EXPECT_GT(bb, 0);
  EXPECT_NEAR(ab, ba, 1e-10 * std::sqrt(aa * bb));
}

template <int Dim, class At>
void expect_symmetric_positive(const StencilMatrix<Dim, At>& matrix) {
  expect_symmetric_positive(matrix, MultigridKind::pfmg);
  expect_symmetric_positive(matrix, MultigridKind::smg);
}

TEST(Multigrid, CycleIsSymmetricAndPositive) {
  const Grid<2> plane({graded_axis(21, 3), uniform_axis(34)}, Geometry::planar);
  expect_symmetric_positive(cell_laplacian(plane, all_but_one));
  expect_symmetric_positive(node_laplacian(plane, all_but_one));
  const Grid<3> space({uniform_axis(9), uniform_axis(12), graded_axis(10, 2)}, Geometry::cartesian);
  expect_symmetric_positive(cell_laplacian(space, all_but_one));
  expect_symmetric_positive(node_laplacian(space, all_but_one));
}

TEST(Multigrid, TakesMasksWithHoles) {
  const Grid<2> grid({uniform_axis(40), uniform_axis(40)}, Geometry::planar);
  const auto ring = [](const Index<2>& i) {
    const double r = std::hypot(i[0] - 19.5, i[1] - 19.5);
    return r > 6 && r < 15;
  };
  expect_symmetric_positive(cell_laplacian(grid, ring));
  expect_symmetric_positive(node_laplacian(grid, ring));
}

TEST(Multigrid, TakesAxesOfOneCell) {
  const Grid<3> slice({uniform_axis(16), uniform_axis(1), uniform_axis(20)}, Geometry::cartesian);
  const auto but_corner = [](const Index<3>& i) { return i[0] > 0 || i[2] > 0; };
  expect_symmetric_positive(cell_laplacian(slice, but_corner));
  expect_symmetric_positive(node_laplacian(slice, but_corner));
  const Grid<3> line({uniform_axis(1), uniform_axis(1), uniform_axis(20)}, Geometry::cartesian);
  expect_symmetric_positive(cell_laplacian(line, [](const Index<3>& i) { return i[2] > 0; }));
  const Grid<2> column({uniform_axis(1), uniform_axis(33)}, Geometry::planar);
  expect_symmetric_positive(cell_laplacian(column, [](const Index<2>& i) { return i[1] > 0; }));
  const Grid<2> row({uniform_axis(33), uniform_axis(1)}, Geometry::planar);
  expect_symmetric_positive(cell_laplacian(row, [](const Index<2>& i) { return i[0] > 0; }));
}

TEST(Multigrid, SolvesASinglePoint) {
  const Grid<2> grid({uniform_axis(1), uniform_axis(1)}, Geometry::planar);
  StencilMatrix<2, Cell> matrix(grid.layout(), Stencil::star);
  const Cell only = grid.cell(Index<2>{});
  matrix.diagonal[only] = 4;
  CellField r(grid.layout()), z(grid.layout());
  r[only] = 2;
  for (const MultigridKind kind : {MultigridKind::pfmg, MultigridKind::smg}) {
    Multigrid<2, Cell>(matrix, kind).cycle(r, z);
    EXPECT_NEAR(z[only], 0.5, 1e-14);
  }
}

TEST(Multigrid, WorksOnAPartOfTheGridAndLeavesTheRestAlone) {
  const Grid<2> grid({uniform_axis(30), uniform_axis(30)}, Geometry::planar);
  const Box<2> part{Index<2>{{5, 7}}, Index<2>{{22, 19}}};
  auto matrix = cell_laplacian(grid, [&](const Index<2>& i) { return part.contains(i); });
  matrix.box = part;
  expect_symmetric_positive(matrix);
  Multigrid<2, Cell> multigrid(matrix, MultigridKind::pfmg);
  CellField z(grid.layout(), 7.0);
  multigrid.cycle(rough_field(matrix), z);
  EXPECT_EQ(z[grid.cell(Index<2>{{4, 8}})], 7.0);
  EXPECT_NE(z[grid.cell(Index<2>{{5, 8}})], 7.0);
}

/// What a cycle makes of a rough residual, hierarchy and all on so many threads.
template <int Dim, class At>
Field<At> cycled(const StencilMatrix<Dim, At>& matrix, MultigridKind kind, int threads) {
  const ThreadScope of_all(threads);
  Field<At> z(matrix.layout);
  Multigrid<Dim, At>(matrix, kind).cycle(rough_field(matrix), z);
  return z;
}

/// Without OpenMP in hypre this is hardly a question.
TEST(Multigrid, CyclesDoNotDependOnTheNumberOfThreads) {
  const auto expect = [](const auto& matrix) {
    for (const MultigridKind kind : {MultigridKind::pfmg, MultigridKind::smg}) {
      auto serial = cycled(matrix, kind, 1);
      for (const int threads : {2, 3}) {
        auto threaded = cycled(matrix, kind, threads);
        EXPECT_EQ(serial.values(), threaded.values()) << threads;
      }
    }
  };
  const Grid<3> space({uniform_axis(32), graded_axis(32, 3), uniform_axis(32)}, Geometry::cartesian);
  expect(cell_laplacian(space, [](const auto& i) { return i[0] + i[1] > 9; }));
  const Grid<2> plane({graded_axis(96, 3), uniform_axis(80)}, Geometry::planar);
  expect(cell_laplacian(plane, all_but_one));
  expect(node_laplacian(plane, all_but_one));
  expect(cell_laplacian(plane.with_periodic({{false, true}}), all_but_one));
}

TEST(Multigrid, CanBeMovedAndRebuilt) {
  const Grid<2> grid({uniform_axis(16), uniform_axis(16)}, Geometry::planar);
  const auto matrix = cell_laplacian(grid, all_but_one);
  const CellField r = rough_field(matrix);
  CellField before(grid.layout()), after(grid.layout());
  Multigrid<2, Cell> first(matrix, MultigridKind::pfmg);
  first.cycle(r, before);
  Multigrid<2, Cell> second = std::move(first);
  first = Multigrid<2, Cell>(matrix, MultigridKind::smg);
  second.cycle(r, after);
  for_each<Cell>(grid.layout(), matrix.box, [&](Cell c) { EXPECT_EQ(before[c], after[c]); });
}

}  // namespace
}  // namespace quicksand
