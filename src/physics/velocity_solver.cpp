#include "physics/velocity_solver.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <vector>

#include "solvers/multigrid.hpp"

namespace quicksand {

namespace {

constexpr int max_iterations = 400;

/// Systems of up to so many cells in the plane are factorised: the multigrid's set-up and its many small loops cost
/// more.
constexpr std::ptrdiff_t largest_direct = 1000;

/// Numbers of the cells of a box, one after the other, and of their copies; -1 elsewhere.
template <int Dim>
Field<Cell, int> number_cells(const Layout<Dim>& layout, const Box<Dim>& box, std::vector<Cell>& cells) {
  Field<Cell, int> number(layout, -1);
  const Rows<Dim> rows(layout, box);
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    for (int i = 0; i < rows.length; ++i) {
      const Cell c{rows.start(r) + i};
      number[c] = static_cast<int>(cells.size());
      cells.push_back(c);
    }
  }
  wrap(layout, box, number);
  return number;
}

/// The lower triangle as a sparse matrix; unknown number = Dim * cell number + component.
template <int Dim>
Eigen::SparseMatrix<double> sparse_lower(const VelocityMatrix<Dim>& matrix, const std::vector<Cell>& cells,
                                         const Field<Cell, int>& number) {
  std::vector<Eigen::Triplet<double>> entries;
  const std::vector<Step>& steps = matrix.component(0).steps;
  entries.reserve(cells.size() * Dim * Dim * (steps.size() + 1));
  for (const Cell c : cells) {
    for (int a = 0; a < Dim; ++a) {
      const int row = Dim * number[c] + a;
      for (int b = 0; b <= a; ++b) entries.emplace_back(row, Dim * number[c] + b, matrix.centre(a, b)[c]);
      for (std::size_t e = 0; e < steps.size(); ++e) {
        const int neighbour = number[c - steps[e]];
        if (neighbour < 0) continue;
        for (int b = 0; b < Dim; ++b) {
          const double value = matrix.lower(a, b, e)[c];
          if (value == 0) continue;
          // Across the ends of a periodic axis the lower neighbour has the higher number.
          const int column = Dim * neighbour + b;
          entries.emplace_back(std::max(row, column), std::min(row, column), value);
        }
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(cells.size()) * Dim;
  Eigen::SparseMatrix<double> sparse(n, n);
  sparse.setFromTriplets(entries.begin(), entries.end());
  return sparse;
}

/// Solution by factors; false when they can't be found, because the matrix is not positive definite to round-off.
template <int Dim>
bool solve_direct(const VelocityMatrix<Dim>& matrix, const CellVectors<Dim>& b, CellVectors<Dim>& x) {
  std::vector<Cell> cells;
  const Field<Cell, int> number = number_cells(matrix.component(0).layout, matrix.box(), cells);
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors(sparse_lower(matrix, cells, number));
  if (factors.info() != Eigen::Success) return false;
  Eigen::VectorXd right(static_cast<Eigen::Index>(cells.size()) * Dim);
  for (const Cell c : cells) {
    for (int a = 0; a < Dim; ++a) right[Dim * number[c] + a] = b[a][c];
  }
  const Eigen::VectorXd solution = factors.solve(right);
  if (!solution.allFinite()) return false;
  for (const Cell c : cells) {
    for (int a = 0; a < Dim; ++a) x[a][c] = solution[Dim * number[c] + a];
  }
  return true;
}

}  // namespace

template <int Dim>
SolveReport solve_velocity(const VelocityMatrix<Dim>& matrix, const CellVectors<Dim>& b, CellVectors<Dim>& x,
                           double relative_tolerance) {
  if (Dim == 2 && matrix.box().size() <= largest_direct && solve_direct(matrix, b, x)) {
    return {.converged = true, .iterations = 1, .residual = 0, .method = "cholesky"};
  }
  std::vector<Multigrid<Dim, Cell>> cycles;
  cycles.reserve(static_cast<std::size_t>(Dim));
  for (int d = 0; d < Dim; ++d) cycles.emplace_back(matrix.component(d), MultigridKind::pfmg);
  const auto precondition = [&](const CellVectors<Dim>& r, CellVectors<Dim>& z) {
    for (int d = 0; d < Dim; ++d) cycles[static_cast<std::size_t>(d)].cycle(r[d], z[d]);
  };
  const auto apply = [&](CellVectors<Dim>& v, CellVectors<Dim>& y) { matrix.apply(v, y); };
  return conjugate_gradients<Cell>(matrix.component(0).layout, matrix.box(), apply, precondition, b, x,
                                   {.relative = relative_tolerance, .max_iterations = max_iterations});
}

template SolveReport solve_velocity(const VelocityMatrix<2>&, const CellVectors<2>&, CellVectors<2>&, double);
template SolveReport solve_velocity(const VelocityMatrix<3>&, const CellVectors<3>&, CellVectors<3>&, double);

}  // namespace quicksand
