#pragma once
/// \file
/// Multigrid cycles on structured matrices, by hypre.
#include <memory>
#include <string>

#include "solvers/stencil_matrix.hpp"

namespace quicksand {

/// Version of the hypre library that the program was built with, such as "2.26.0".
std::string hypre_version();

/// PFMG: semi-coarsening with point relaxation, cheap; wants an aspect ratio that is about the same everywhere.
/// SMG: semi-coarsening with plane relaxation, several times dearer; takes any grading.
enum class MultigridKind { pfmg, smg };

/// Whether PFMG converges well for 27-point matrices: it does from hypre 3 on (hypre 2.26 takes eight times the
/// iterations).
bool pfmg_suits_27_points();

/// One multigrid hierarchy of a matrix, to be used as a preconditioner of conjugate gradients.
///
/// The hierarchy holds the matrix as it was when constructed: build a new one when coefficients change (set-up costs
/// two to eight cycles). Starts MPI on first use when hypre needs it and nobody did.
template <int Dim, class At>
class Multigrid {
 public:
  /// \throws NumericalError when hypre reports an error in the set-up
  Multigrid(const StencilMatrix<Dim, At>& matrix, MultigridKind kind);
  ~Multigrid();
  Multigrid(Multigrid&&) noexcept;
  Multigrid& operator=(Multigrid&&) noexcept;

  /// z = M^-1 r on the matrix' box: one symmetric cycle from a zero guess. Values outside the box are left alone.
  void cycle(const Field<At>& r, Field<At>& z);

 private:
  struct Hierarchy;
  std::unique_ptr<Hierarchy> hierarchy_;
};

extern template class Multigrid<2, Cell>;
extern template class Multigrid<2, Node>;
extern template class Multigrid<3, Cell>;
extern template class Multigrid<3, Node>;

}  // namespace quicksand
