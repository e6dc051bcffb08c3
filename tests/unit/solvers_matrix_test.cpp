#include <gtest/gtest.h>

#include <cmath>

#include "solvers/stencil_matrix.hpp"
#include "unit/solvers_problems.hpp"

namespace quicksand {
namespace {

using problems::cell_laplacian;
using problems::graded_axis;
using problems::node_laplacian;
using problems::rough_field;
using problems::uniform_axis;

const auto everywhere = [](const auto&) { return true; };

/// The same product from multi-indices, coupling by coupling.
template <int Dim, class At>
double naive_row(const StencilMatrix<Dim, At>& matrix, const Field<At>& x, const Index<Dim>& i) {
  const At p{matrix.layout.flat(i)};
  double total = matrix.diagonal[p] * x[p];
  for (std::size_t e = 0; e < matrix.offsets.size(); ++e) {
    Index<Dim> below = i;
    Index<Dim> above = i;
    for (int d = 0; d < Dim; ++d) {
      below[d] += matrix.offsets[e][d];
      above[d] -= matrix.offsets[e][d];
    }
    below = matrix.layout.image(below);
    above = matrix.layout.image(above);
    const At low{matrix.layout.flat(below)};
    const At high{matrix.layout.flat(above)};
    if (matrix.box.contains(below)) total += matrix.lower[e][p] * x[low];
    if (matrix.box.contains(above)) total += matrix.lower[e][high] * x[high];
  }
  return total;
}

template <int Dim, class At>
double largest_apply_error(const StencilMatrix<Dim, At>& matrix) {
  Field<At> x = rough_field(matrix);
  Field<At> y(matrix.layout);
  matrix.apply(x, y);
  return maximum<At>(matrix.layout, matrix.box, 0.0,
                     [&](At p) { return std::abs(y[p] - naive_row(matrix, x, matrix.layout.multi(p.n))); });
}

Grid<2> graded_grid_2d() { return Grid<2>({graded_axis(9, 4), graded_axis(7, 3)}, Geometry::planar); }
Grid<3> graded_grid_3d() {
  return Grid<3>({graded_axis(6, 4), graded_axis(5, 3), graded_axis(4, 2)}, Geometry::cartesian);
}

TEST(StencilMatrix, OffsetsBeginWithTheAxesAndLeadDown) {
  EXPECT_EQ(lower_offsets<2>(Stencil::star).size(), 2u);
  EXPECT_EQ(lower_offsets<2>(Stencil::box).size(), 4u);
  EXPECT_EQ(lower_offsets<3>(Stencil::star).size(), 3u);
  EXPECT_EQ(lower_offsets<3>(Stencil::box).size(), 13u);
  const StencilMatrix<3, Node> matrix(Layout<3>(Index<3>{{4, 5, 6}}), Stencil::box);
  for (int d = 0; d < 3; ++d) EXPECT_EQ(matrix.steps[static_cast<std::size_t>(d)].n, matrix.layout.step(d).n);
  for (const Step s : matrix.steps) EXPECT_GT(s.n, 0);
  EXPECT_EQ(matrix.box.extent(0), 5);
}

TEST(StencilMatrix, AppliesEveryStencil) {
  EXPECT_LT(largest_apply_error(cell_laplacian(graded_grid_2d(), everywhere)), 1e-12);
  EXPECT_LT(largest_apply_error(node_laplacian(graded_grid_2d(), everywhere)), 1e-12);
  EXPECT_LT(largest_apply_error(cell_laplacian(graded_grid_3d(), everywhere)), 1e-12);
  EXPECT_LT(largest_apply_error(node_laplacian(graded_grid_3d(), everywhere)), 1e-12);
}

TEST(StencilMatrix, ResidualIsRightHandSideMinusProduct) {
  const auto matrix = cell_laplacian(graded_grid_2d(), everywhere);
  CellField x = rough_field(matrix);
  CellField y(matrix.layout), r(matrix.layout);
  matrix.apply(x, y);
  matrix.residual(x, x, r);
  for_each<Cell>(matrix.layout, matrix.box, [&](Cell c) { EXPECT_DOUBLE_EQ(r[c], x[c] - y[c]); });
}

TEST(StencilMatrix, IdentityRowsLeaveNoCoupling) {
  auto matrix = node_laplacian(graded_grid_2d(), everywhere);
  const Node p{matrix.layout.flat(Index<2>{{3, 4}})};
  EXPECT_FALSE(matrix.uncoupled(p));
  matrix.set_identity(p);
  EXPECT_TRUE(matrix.uncoupled(p));
  NodeField unit(matrix.layout), product(matrix.layout);
  unit[p] = 1;
  matrix.apply(unit, product);
  for_each<Node>(matrix.layout, matrix.box, [&](Node q) { EXPECT_EQ(product[q], q == p ? 1.0 : 0.0); });
}

TEST(StencilMatrix, StarPartOfBilinearElementsIsTheFiniteVolumeLaplacian) {
  const Grid<2> grid({uniform_axis(6, 0, 3), uniform_axis(5)}, Geometry::planar);
  const auto star = star_part(node_laplacian(grid, everywhere));
  const Node inner{grid.layout().flat(Index<2>{{3, 2}})};
  // h_z / h_x = 0.2 / 0.5 along x, the inverse along z.
  EXPECT_NEAR(star.lower[0][inner], -0.4, 1e-14);
  EXPECT_NEAR(star.lower[1][inner], -2.5, 1e-14);
}

TEST(StencilMatrix, StarPartKeepsRowSumsAndSigns) {
  const auto inside = [](const Index<3>& i) { return i[0] + i[2] < 6; };
  const auto matrix = node_laplacian(graded_grid_3d(), inside);
  const auto star = star_part(matrix);
  for_each<Node>(matrix.layout, matrix.box, [&](Node p) {
    EXPECT_NEAR(star.row_sum(p), matrix.row_sum(p), 1e-13);
    EXPECT_TRUE(star.uncoupled(p) || !matrix.uncoupled(p));
    for (const NodeField& coupling : star.lower) EXPECT_LE(coupling[p], 0);
  });
}

TEST(StencilMatrix, BoundingBoxIsTight) {
  const Layout<3> layout(Index<3>{{8, 9, 10}});
  const Box<3> all{Index<3>{}, layout.cells()};
  CellMask mask(layout, 0);
  EXPECT_TRUE(bounding_box<Cell>(layout, all, [&](Cell c) { return mask[c] != 0; }).empty());
  mask[Cell{layout.flat(Index<3>{{2, 7, 4}})}] = 1;
  mask[Cell{layout.flat(Index<3>{{5, 3, 9}})}] = 1;
  const Box<3> expected{Index<3>{{2, 3, 4}}, Index<3>{{6, 8, 10}}};
  EXPECT_EQ(bounding_box<Cell>(layout, all, [&](Cell c) { return mask[c] != 0; }), expected);
}

}  // namespace
}  // namespace quicksand
