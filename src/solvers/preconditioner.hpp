#pragma once
/// \file
/// Preconditioners of stencil matrices, and which of them suits a matrix.
#include <memory>
#include <string_view>

#include "solvers/stencil_matrix.hpp"

namespace quicksand {

/// Ways to solve a stencil matrix. `automatic` chooses by size, stencil and grading.
enum class Method {
  automatic,
  direct,     ///< banded Cholesky factorisation; for small and slender boxes
  pfmg,       ///< CG + PFMG
  star_pfmg,  ///< CG + PFMG of the star_part(); for 9/27-point matrices
  smg,        ///< CG + SMG
  jacobi,     ///< CG + diagonal; the last resort
};

/// Name of a method for reports.
std::string_view name(Method method);

/// Systems whose neighbours' numbers differ by no more than this are factorised. Wider ones cost less with multigrid.
inline constexpr int widest_scalar_band = 80;

/// Whether systems on a box are small or slender enough to be factorised.
template <int Dim>
bool suits_factors(const Layout<Dim>& layout, const Box<Dim>& box);

/// The method that `automatic` stands for.
template <int Dim, class At>
Method choose_method(const StencilMatrix<Dim, At>& matrix);

/// A symmetric approximation of the inverse of a matrix, to be applied many times. Holds the matrix as it was when
/// constructed; the set-up is worth two applications on large grids and eight on small ones.
template <int Dim, class At>
class Preconditioner {
 public:
  /// \throws NumericalError when the set-up fails (a matrix that is not positive definite, an error in hypre)
  explicit Preconditioner(const StencilMatrix<Dim, At>& matrix, Method method = Method::automatic);
  ~Preconditioner();
  Preconditioner(Preconditioner&&) noexcept;
  Preconditioner& operator=(Preconditioner&&) noexcept;

  /// z ~ A^-1 r on the matrix' box. Values outside the box are left alone.
  void operator()(const Field<At>& r, Field<At>& z);
  Method method() const { return method_; }

 private:
  struct Apply;
  Method method_;
  std::unique_ptr<Apply> apply_;
};

}  // namespace quicksand
