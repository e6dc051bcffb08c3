#include "solvers/linear_solver.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Whether the constants over the coupled rows are in the null space: all-Neumann problems.
template <int Dim, class At>
bool is_singular(const StencilMatrix<Dim, At>& matrix) {
  constexpr double round_off = 1e-13;
  const auto coupled_sum = [&](auto&& f) {
    return sum<At>(matrix.layout, matrix.box, [&](At p) { return matrix.uncoupled(p) ? 0.0 : f(p); });
  };
  const double diagonal = coupled_sum([&](At p) { return matrix.diagonal[p]; });
  return diagonal > 0 && coupled_sum([&](At p) { return std::abs(matrix.row_sum(p)); }) <= round_off * diagonal;
}

/// The rows of a matrix that couple to others.
template <int Dim, class At>
class CoupledRows {
 public:
  explicit CoupledRows(const StencilMatrix<Dim, At>& matrix)
      : layout_(matrix.layout), box_(matrix.box), coupled_(matrix.layout) {
    for_each<At>(layout_, box_, [&](At p) { coupled_[p] = matrix.uncoupled(p) ? 0 : 1; });
  }
  /// x -= constant on them.
  void subtract(double constant, Field<At>& x) const {
    for_each<At>(layout_, box_, [&](At p) { x[p] -= coupled_[p] ? constant : 0.0; });
  }
  void remove_mean(Field<At>& x) const {
    const auto coupled_sum = [&](auto&& f) {
      return sum<At>(layout_, box_, [&](At p) { return coupled_[p] ? f(p) : 0.0; });
    };
    subtract(coupled_sum([&](At p) { return x[p]; }) / coupled_sum([](At) { return 1.0; }), x);
  }

 private:
  Layout<Dim> layout_;
  Box<Dim> box_;
  Field<At, unsigned char> coupled_;
};

/// The first coupled row of a matrix that has any.
template <int Dim, class At>
At first_coupled(const StencilMatrix<Dim, At>& matrix) {
  const Rows<Dim> rows(matrix.layout, matrix.box);
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    for (int i = 0; i < rows.length; ++i) {
      const At p{rows.start(r) + i};
      if (!matrix.uncoupled(p)) return p;
    }
  }
  return At{rows.start(0)};
}

/// One attempt from the guess x. A method that can't be set up counts as not converged.
template <int Dim, class At>
SolveReport attempt(const StencilMatrix<Dim, At>& matrix, Method method, const Field<At>& b, Field<At>& x,
                    Tolerance tolerance) {
  // Without multigrid the iterations grow with the number of points across the box.
  if (method == Method::jacobi) tolerance.max_iterations *= 20;
  try {
    Preconditioner<Dim, At> preconditioner(matrix, method);
    return solve(matrix, preconditioner, b, x, tolerance);
  } catch (const NumericalError&) {
    SolveReport failure;
    failure.residual = std::numeric_limits<double>::infinity();
    failure.method = name(method);
    return failure;
  }
}

template <int Dim, class At>
SolveReport solve_definite(const StencilMatrix<Dim, At>& matrix, const Field<At>& b, Field<At>& x,
                           const SolveOptions& options) {
  const Method first = options.method == Method::automatic ? choose_method(matrix) : options.method;
  SolveReport report = attempt(matrix, first, b, x, options);
  for (const Method method : {Method::smg, Method::jacobi}) {
    if (report.converged || method == first) continue;
    // The failed attempt may have gone astray, and so may the guess: begin anew, and keep the better result.
    Field<At> candidate = x;
    for_each<At>(matrix.layout, matrix.box, [&](At p) { candidate[p] = 0; });
    SolveReport next = attempt(matrix, method, b, candidate, options);
    next.iterations += report.iterations;
    if (next.converged || next.residual < report.residual || !std::isfinite(report.residual)) {
      report = next;
      std::swap(x, candidate);
    }
  }
  return report;
}

/// Doubles one diagonal for a while, which makes a singular matrix definite.
template <int Dim, class At>
class Pin {
 public:
  Pin(StencilMatrix<Dim, At>& matrix, At at) : entry_(matrix.diagonal[at]), value_(entry_) { entry_ *= 2; }
  ~Pin() { entry_ = value_; }
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;

 private:
  double& entry_;
  double value_;
};

}  // namespace

template <int Dim, class At>
SolveReport solve(const StencilMatrix<Dim, At>& matrix, Preconditioner<Dim, At>& preconditioner, const Field<At>& b,
                  Field<At>& x, const Tolerance& tolerance) {
  SolveReport report = conjugate_gradients<At>(
      matrix.layout, matrix.box, [&](Field<At>& v, Field<At>& Av) { matrix.apply(v, Av); }, preconditioner, b, x,
      tolerance);
  report.method = name(preconditioner.method());
  return report;
}

template <int Dim, class At>
SolveReport solve(StencilMatrix<Dim, At>& matrix, Field<At>& b, Field<At>& x, const SolveOptions& options) {
  if (matrix.box.empty()) {
    SolveReport nothing;
    nothing.converged = true;
    nothing.method = "nothing to solve";
    return nothing;
  }
  if (!is_singular(matrix)) return solve_definite(matrix, b, x, options);
  // With one diagonal doubled the matrix is definite; for a consistent right-hand side it picks the solution that is
  // zero at that point. So is the guess made, lest a good one look bad.
  const At at = first_coupled(matrix);
  const CoupledRows<Dim, At> coupled(matrix);
  coupled.subtract(x[at], x);
  coupled.remove_mean(b);
  const Pin<Dim, At> pin(matrix, at);
  const SolveReport report = solve_definite(matrix, b, x, options);
  coupled.remove_mean(x);
  return report;
}

template <int Dim, class At>
SolveReport solve(const Operator<At>& apply, StencilMatrix<Dim, At> star, Field<At>& b, Field<At>& x,
                  const SolveOptions& options) {
  const Layout<Dim> layout = star.layout;
  const Box<Dim> box = star.box;
  SolveReport report;
  report.method = name(Method::star_pfmg);
  if (choose_method(star) != Method::pfmg) return report;
  std::optional<CoupledRows<Dim, At>> null_space;
  if (is_singular(star)) {
    // As above, but the operator may stay singular: what conjugate gradients do keeps a right-hand side consistent.
    null_space.emplace(star);
    null_space->remove_mean(b);
    star.diagonal[first_coupled(star)] *= 2;
  }
  try {
    Preconditioner<Dim, At> preconditioner(star, Method::pfmg);
    star = {};  // the hierarchy has copies
    report = conjugate_gradients<At>(layout, box, apply, preconditioner, b, x, options);
  } catch (const NumericalError&) {
    report.residual = std::numeric_limits<double>::infinity();
  }
  report.method = name(Method::star_pfmg);
  if (null_space) null_space->remove_mean(x);
  return report;
}

void require_converged(const SolveReport& report, std::string_view what) {
  if (report.converged) return;
  std::ostringstream message;
  message << what << ": the linear solve did not converge (" << report.method << ", " << report.iterations
          << " iterations, relative residual " << report.residual << ")";
  throw NumericalError(message.str());
}

template SolveReport solve(const Operator<Node>&, StencilMatrix<2, Node>, Field<Node>&, Field<Node>&,
                           const SolveOptions&);
template SolveReport solve(const Operator<Node>&, StencilMatrix<3, Node>, Field<Node>&, Field<Node>&,
                           const SolveOptions&);
template SolveReport solve(StencilMatrix<2, Cell>&, Field<Cell>&, Field<Cell>&, const SolveOptions&);
template SolveReport solve(StencilMatrix<2, Node>&, Field<Node>&, Field<Node>&, const SolveOptions&);
template SolveReport solve(StencilMatrix<3, Cell>&, Field<Cell>&, Field<Cell>&, const SolveOptions&);
template SolveReport solve(StencilMatrix<3, Node>&, Field<Node>&, Field<Node>&, const SolveOptions&);

template SolveReport solve(const StencilMatrix<2, Cell>&, Preconditioner<2, Cell>&, const Field<Cell>&, Field<Cell>&,
                           const Tolerance&);
template SolveReport solve(const StencilMatrix<2, Node>&, Preconditioner<2, Node>&, const Field<Node>&, Field<Node>&,
                           const Tolerance&);
template SolveReport solve(const StencilMatrix<3, Cell>&, Preconditioner<3, Cell>&, const Field<Cell>&, Field<Cell>&,
                           const Tolerance&);
template SolveReport solve(const StencilMatrix<3, Node>&, Preconditioner<3, Node>&, const Field<Node>&, Field<Node>&,
                           const Tolerance&);

}  // namespace quicksand
