#pragma once
/// \file
/// Symmetric matrices that couple all velocity components of neighbouring cells.
#include <array>
#include <vector>

#include "solvers/stencil_matrix.hpp"

namespace quicksand {

/// Symmetric matrix on cell vectors: Dim x Dim blocks on a box stencil.
///
/// Row (c, a) couples to (c, b) by centre(a, b)(c), to (c - s_e, b) by lower(a, b, e)(c) and to (c + s_e, b) by
/// lower(b, a, e)(c + s_e). The blocks of equal components are stencil matrices of their own, as a preconditioner wants
/// them.
template <int Dim>
class VelocityMatrix {
 public:
  explicit VelocityMatrix(const Layout<Dim>& layout);

  const Box<Dim>& box() const { return box_; }
  void set_box(const Box<Dim>& box);
  /// Zero in all entries of rows of the box. The entries come into being here: flows without stress, and those that do
  /// with less, don't pay for them.
  void clear();

  StencilMatrix<Dim, Cell>& component(int a) { return diagonal_[at(a)]; }
  const StencilMatrix<Dim, Cell>& component(int a) const { return diagonal_[at(a)]; }
  /// Coupling of components a and b in one cell; centre(a, b) and centre(b, a) are the same field.
  CellField& centre(int a, int b) { return a == b ? diagonal_[at(a)].diagonal : cross_centre_[pair(a, b)]; }
  const CellField& centre(int a, int b) const { return a == b ? diagonal_[at(a)].diagonal : cross_centre_[pair(a, b)]; }
  /// Coupling of component a in cell c with component b in cell c - s_e.
  CellField& lower(int a, int b, std::size_t e) {
    return a == b ? diagonal_[at(a)].lower[e] : cross_lower_[at(a * Dim + b)][e];
  }
  const CellField& lower(int a, int b, std::size_t e) const {
    return a == b ? diagonal_[at(a)].lower[e] : cross_lower_[at(a * Dim + b)][e];
  }
  const std::vector<Index<Dim>>& offsets() const { return offsets_; }

  /// To be called when the couplings have been written: copies them across the ends of periodic axes.
  void wrap_couplings();
  /// y = A x on the box; x counts as zero outside. Where the box wraps, the layer around it is written to.
  void apply(CellVectors<Dim>& x, CellVectors<Dim>& y) const;

 private:
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static constexpr std::size_t pair(int a, int b) { return at(a + b - 1); }  // (0,1) (0,2) (1,2) -> 0 1 2

  Layout<Dim> layout_;
  Box<Dim> box_;
  std::vector<Index<Dim>> offsets_;
  std::vector<StencilMatrix<Dim, Cell>> diagonal_;
  std::vector<CellField> cross_centre_;
  std::vector<std::vector<CellField>> cross_lower_;  // [a * Dim + b], empty for a == b
};

extern template class VelocityMatrix<2>;
extern template class VelocityMatrix<3>;

}  // namespace quicksand
