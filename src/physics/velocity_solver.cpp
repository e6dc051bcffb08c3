#include "physics/velocity_solver.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solvers/banded_cholesky.hpp"
#include "solvers/multigrid.hpp"

namespace quicksand {

namespace {

constexpr int max_iterations = 400;

}  // namespace

/// Banded Cholesky factors; unusable where the matrix is not positive definite to round-off. Unknown number = Dim *
/// cell number + component.
template <int Dim>
struct VelocitySolver<Dim>::Factors {
  BandOrder<Dim> order;
  BandedCholesky factors;
  bool usable;
  std::vector<double> packed;

  static int bandwidth(const BandOrder<Dim>& order) { return Dim * order.bandwidth() + Dim - 1; }

  Factors(const VelocityMatrix<Dim>& matrix, const BandOrder<Dim>& band)
      : order(band), factors(Dim * order.size(), bandwidth(order)) {
    order.template for_each<Cell>([&](Cell c, const Index<Dim>& i, int n) {
      for (int a = 0; a < Dim; ++a) factors.begin(Dim * n + a);
      for (int a = 0; a < Dim; ++a) {
        for (int b = 0; b <= a; ++b) factors.add(Dim * n + a, Dim * n + b, matrix.centre(a, b)[c]);
      }
      // Of the two cells of a coupling that one reads and adds it whose unknown it belongs to.
      const auto couple = [&](int row, int neighbour, int component, const double& value) {
        const int column = Dim * neighbour + component;
        if (neighbour >= 0 && neighbour != n && factors.owner(row, column) == row) factors.add(row, column, value);
      };
      for (std::size_t e = 0; e < matrix.offsets().size(); ++e) {
        const Index<Dim>& offset = matrix.offsets()[e];
        const int below = order.number(i + offset);
        const int above = order.number(i - offset);
        const Cell next = c + matrix.component(0).steps[e];
        for (int a = 0; a < Dim; ++a) {
          for (int b = 0; b < Dim; ++b) {
            // On an axis of one cell, that is periodic, a cell is its own neighbour.
            if (below == n) factors.add(Dim * n + a, Dim * n + b, matrix.lower(a, b, e)[c]);
            couple(Dim * n + a, below, b, matrix.lower(a, b, e)[c]);
            couple(Dim * n + a, above, b, matrix.lower(b, a, e)[next]);
          }
        }
      }
    });
    usable = factors.factorize();
  }
  /// Returns false when the solution is not finite.
  bool solve(const CellVectors<Dim>& b, CellVectors<Dim>& x) {
    if (!usable) return false;
    packed.resize(Dim * static_cast<std::size_t>(order.size()));
    const auto at = [&](int n, int a) { return Dim * static_cast<std::size_t>(n) + static_cast<std::size_t>(a); };
    order.template for_each<Cell>([&](Cell c, const Index<Dim>&, int n) {
      for (int a = 0; a < Dim; ++a) packed[at(n, a)] = b[a][c];
    });
    factors.solve(packed);
    if (!std::all_of(packed.begin(), packed.end(), [](double v) { return std::isfinite(v); })) return false;
    order.template for_each<Cell>([&](Cell c, const Index<Dim>&, int n) {
      for (int a = 0; a < Dim; ++a) x[a][c] = packed[at(n, a)];
    });
    return true;
  }
};

/// Multigrid of the blocks of equal components.
template <int Dim>
struct VelocitySolver<Dim>::Cycles {
  std::vector<Multigrid<Dim, Cell>> of_component;

  explicit Cycles(const VelocityMatrix<Dim>& matrix) {
    of_component.reserve(static_cast<std::size_t>(Dim));
    const bool whole = Dim == 2 || pfmg_suits_27_points();
    for (int d = 0; d < Dim; ++d) {
      const StencilMatrix<Dim, Cell>& block = matrix.component(d);
      of_component.emplace_back(whole ? block : star_part(block), MultigridKind::pfmg);
    }
  }
};

template <int Dim>
VelocitySolver<Dim>::VelocitySolver(const VelocityMatrix<Dim>& matrix) : matrix_(&matrix) {
  const BandOrder<Dim> order(matrix.component(0).layout, matrix.box());
  if (Factors::bandwidth(order) <= widest_velocity_band) factors_ = std::make_unique<Factors>(matrix, order);
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
