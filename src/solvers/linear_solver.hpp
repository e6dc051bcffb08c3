#pragma once
/// \file
/// Symmetric positive definite linear systems: which preconditioner suits a stencil matrix, and fallbacks when it does
/// not.
#include <functional>
#include <string_view>

#include "solvers/conjugate_gradients.hpp"
#include "solvers/preconditioner.hpp"
#include "solvers/stencil_matrix.hpp"

namespace quicksand {

struct SolveOptions : Tolerance {
  Method method = Method::automatic;
};

/// Solves A x = b on the matrix' box; x is the initial guess on entry.
///
/// A must be symmetric and positive definite or, all-Neumann, have the constants (over the rows that are not identity
/// rows) as its null space. The latter is recognised by the row sums; then b is made consistent by removing its mean,
/// x is returned with mean zero; the matrix changes meanwhile and is the same on return. When the method does not
/// converge, SMG and then Jacobi begin from zero; the best x is kept.
///
/// \param b  right-hand side on the box; must be finite. Keeps its values but for a mean that is removed
/// \param x  on entry the guess; the layer around the box must be zero wherever couplings there are not
/// \returns  the report; a caller that can't go on without convergence passes it to require_converged()
template <int Dim, class At>
[[nodiscard]] SolveReport solve(StencilMatrix<Dim, At>& matrix, Field<At>& b, Field<At>& x,
                                const SolveOptions& options = {});

/// y = A x on a box, written as a function.
template <class At>
using Operator = std::function<void(Field<At>& x, Field<At>& y)>;

/// The same for an operator behind PFMG of the star part of its matrix, which need not be there as a whole. A star part
/// that calls for another method, and a solve that fails, make a report that is not converged: there are no fallbacks.
///
/// \param star  star_part() of the matrix, by which a singular one is recognised
/// \param b, x  0 on identity rows
template <int Dim, class At>
[[nodiscard]] SolveReport solve(const Operator<At>& apply, StencilMatrix<Dim, At> star, Field<At>& b, Field<At>& x,
                                const SolveOptions& options);

/// The same with a preconditioner that the caller keeps, for matrices that stay; neither fallbacks nor singular
/// matrices.
template <int Dim, class At>
[[nodiscard]] SolveReport solve(const StencilMatrix<Dim, At>& matrix, Preconditioner<Dim, At>& preconditioner,
                                const Field<At>& b, Field<At>& x, const Tolerance& tolerance);

/// \throws NumericalError naming `what`, the method, the iterations and the residual when the solve did not converge
void require_converged(const SolveReport& report, std::string_view what);

}  // namespace quicksand
