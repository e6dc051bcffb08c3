#pragma once
/// \file
/// Symmetric matrices with a compact stencil on the cells or nodes of a grid.
#include <algorithm>
#include <vector>

#include "core/field.hpp"
#include "core/layout.hpp"
#include "core/loop.hpp"
#include "core/periodic.hpp"

namespace quicksand {

/// Which neighbours a row couples: along the axes only (5/7 points) or the whole 3^Dim block (9/27 points).
enum class Stencil { star, box };

/// Multi-index offsets of the neighbours with a lower flat number; the others follow by symmetry. The offsets of a star
/// come first in either stencil, in the order of the axes: offset d is one step down along axis d.
template <int Dim>
std::vector<Index<Dim>> lower_offsets(Stencil stencil);

/// Symmetric matrix on the points `At` (cells or nodes) of a box.
///
/// (A x)(p) = diagonal(p) x(p) + sum over e of [ lower(e)(p) x(p - s_e) + lower(e)(p + s_e) x(p + s_e) ]
/// where s_e = -(lower offset e) as a flat step. Points outside the mask (rows not solved for) carry diagonal 1 and
/// couplings 0: identity rows with symmetric elimination. Where the box wraps along a periodic axis, p - s_e and p +
/// s_e go on at its other end: the layer around the box then holds copies, of x and of the couplings.
template <int Dim, class At>
struct StencilMatrix {
  StencilMatrix() = default;
  /// Matrix of zeros on all positions of the layout's owned cells or, for nodes, one more along every axis that is not
  /// periodic.
  StencilMatrix(const Layout<Dim>& layout, Stencil stencil);

  Layout<Dim> layout;
  Stencil stencil = Stencil::star;
  Box<Dim> box;                     ///< points of the system; x outside the box counts as zero
  std::vector<Index<Dim>> offsets;  ///< lower_offsets(stencil)
  std::vector<Step> steps;          ///< positive flat steps, steps[e] = -flat(offsets[e])
  Field<At> diagonal;
  std::vector<Field<At>> lower;  ///< lower[e](p) couples p with p - steps[e]

  bool wraps(int d) const { return layout.wraps(box, d); }
  /// To be called when the couplings in the box have been written: copies them across the ends of periodic axes. Along
  /// one of a single point, where a point is its own neighbour, they become part of the other entries.
  void wrap_couplings();
  /// y = A x on the box. x must be zero in the layer around the box wherever the coupling there is not zero; where the
  /// box wraps, that layer is written to.
  void apply(Field<At>& x, Field<At>& y) const { apply(x, y, box); }
  /// The same on a part of the box; x in the layer around that part counts.
  void apply(Field<At>& x, Field<At>& y, const Box<Dim>& where) const;
  /// r = b - A x on the box, under the same condition on x.
  void residual(const Field<At>& b, Field<At>& x, Field<At>& r) const { residual(b, x, r, box); }
  void residual(const Field<At>& b, Field<At>& x, Field<At>& r, const Box<Dim>& where) const;
  /// Row p becomes an identity row with symmetric elimination, before wrap_couplings(). Writes to p's neighbours: not
  /// for threaded loops.
  void set_identity(At p);
  /// Sum of the entries of row p.
  double row_sum(At p) const;
  /// Whether row p couples to nothing, as identity rows do.
  bool uncoupled(At p) const;

 private:
  /// Moves the couplings of lower offset e to where `offset` leads from every row.
  void fold(std::size_t e, const Index<Dim>& offset);
};

/// The 5/7-point matrix nearest to a 9/27-point one: a preconditioner with the same row sums and the same Dirichlet
/// rows.
///
/// The coupling of p with p + s adds half of itself, for every axis along which s moves, to the two edges parallel to
/// that axis at p and at p + s. For bilinear elements of any aspect ratio this gives the finite-volume Laplacian.
/// Couplings of the wrong sign are moved to the diagonal, so that the result is an M-matrix.
template <int Dim, class At>
StencilMatrix<Dim, At> star_part(const StencilMatrix<Dim, At>& matrix);

/// `box` itself, but all of `whole` along the axes on which that wraps and `box` reaches an end of it: what lies beyond
/// is at the other end.
template <int Dim>
Box<Dim> close_rings(const Layout<Dim>& layout, Box<Dim> box, const Box<Dim>& whole) {
  for (int d = 0; d < Dim; ++d) {
    if (!layout.wraps(whole, d) || (box.lo[d] > whole.lo[d] && box.hi[d] < whole.hi[d])) continue;
    box.lo[d] = whole.lo[d];
    box.hi[d] = whole.hi[d];
  }
  return box;
}

/// The smallest box around the points of `box` where inside(At) holds, empty if there is none. The cost of a solve is
/// that of its box: set StencilMatrix::box to the bounding box of the rows that are no identity rows. Where it reaches
/// an end of a periodic axis it spans the axis.
template <class At, int Dim, class Inside>
Box<Dim> bounding_box(const Layout<Dim>& layout, const Box<Dim>& box, Inside&& inside) {
  Box<Dim> found{box.hi, box.lo};
  // Row by row along axis 0; serial, because a minimum over multi-indices is not worth a reduction of its own.
  const Rows<Dim> rows(layout, box);
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    const std::ptrdiff_t start = rows.start(r);
    int first = 0;
    while (first < rows.length && !inside(At{start + first})) ++first;
    if (first == rows.length) continue;
    int last = rows.length - 1;
    while (!inside(At{start + last})) --last;
    const Index<Dim> index = layout.multi(start);
    for (int d = 0; d < Dim; ++d) {
      found.lo[d] = std::min(found.lo[d], d == 0 ? index[0] + first : index[d]);
      found.hi[d] = std::max(found.hi[d], (d == 0 ? index[0] + last : index[d]) + 1);
    }
  }
  return found.empty() ? found : close_rings(layout, found, box);
}

}  // namespace quicksand
