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

}  // namespace

/// Sparse Cholesky factors; unusable where the matrix is not positive definite to round-off.
template <int Dim>
struct VelocitySolver<Dim>::Factors {
  std::vector<Cell> cells;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors;

  explicit Factors(const VelocityMatrix<Dim>& matrix) {
    const Field<Cell, int> number = number_cells(matrix.component(0).layout, matrix.box(), cells);
    factors.compute(sparse_lower(matrix, cells, number));
  }
  /// Returns false when the solution is not finite.
  bool solve(const CellVectors<Dim>& b, CellVectors<Dim>& x) const {
    if (factors.info() != Eigen::Success) return false;
    Eigen::VectorXd vector(static_cast<Eigen::Index>(cells.size()) * Dim);
    Eigen::Index k = 0;
    for (const Cell c : cells) {
      for (int a = 0; a < Dim; ++a) vector[k++] = b[a][c];
    }
    vector = factors.solve(vector).eval();
    if (!vector.allFinite()) return false;
    k = 0;
    for (const Cell c : cells) {
      for (int a = 0; a < Dim; ++a) x[a][c] = vector[k++];
    }
    return true;
  }
};

/// Multigrid of the blocks of equal components.
template <int Dim>
struct VelocitySolver<Dim>::Cycles {
  std::vector<Multigrid<Dim, Cell>> of_component;

  explicit Cycles(const VelocityMatrix<Dim>& matrix) {
    of_component.reserve(static_cast<std::size_t>(Dim));
    for (int d = 0; d < Dim; ++d) of_component.emplace_back(matrix.component(d), MultigridKind::pfmg);
  }
};

template <int Dim>
VelocitySolver<Dim>::VelocitySolver(const VelocityMatrix<Dim>& matrix) : matrix_(&matrix) {
  if (Dim == 2 && matrix.box().size() <= largest_direct) factors_ = std::make_unique<Factors>(matrix);
}
template <int Dim>
VelocitySolver<Dim>::~VelocitySolver() = default;
template <int Dim>
VelocitySolver<Dim>::VelocitySolver(VelocitySolver&&) noexcept = default;
template <int Dim>
VelocitySolver<Dim>& VelocitySolver<Dim>::operator=(VelocitySolver&&) noexcept = default;

template <int Dim>
SolveReport VelocitySolver<Dim>::solve(const CellVectors<Dim>& b, CellVectors<Dim>& x, double relative_tolerance) {
  if (factors_ && factors_->solve(b, x)) {
    return {.converged = true, .iterations = 1, .residual = 0, .method = "cholesky"};
  }
  if (!cycles_) cycles_ = std::make_unique<Cycles>(*matrix_);
  const auto precondition = [&](const CellVectors<Dim>& r, CellVectors<Dim>& z) {
    for (int d = 0; d < Dim; ++d) cycles_->of_component[static_cast<std::size_t>(d)].cycle(r[d], z[d]);
  };
  const auto apply = [&](CellVectors<Dim>& v, CellVectors<Dim>& y) { matrix_->apply(v, y); };
  return conjugate_gradients<Cell>(matrix_->component(0).layout, matrix_->box(), apply, precondition, b, x,
                                   {.relative = relative_tolerance, .max_iterations = max_iterations});
}

template class VelocitySolver<2>;
template class VelocitySolver<3>;

}  // namespace quicksand
