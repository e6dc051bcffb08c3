#include "solvers/stencil_matrix.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <type_traits>

namespace quicksand {

namespace {

/// Sum over the off-diagonal couplings of row p times x. `Count` is the number of lower couplings, a constant so that
/// the loop unrolls and the loop over p vectorises.
template <std::size_t Count, class At>
struct Couplings {
  std::array<const double*, Count> coefficient;
  std::array<std::ptrdiff_t, Count> step;

  template <int Dim>
  explicit Couplings(const StencilMatrix<Dim, At>& matrix) {
    for (std::size_t e = 0; e < Count; ++e) {
      coefficient[e] = &matrix.lower[e][At{0}];
      step[e] = matrix.steps[e].n;
    }
  }
  double times(const double* x, std::ptrdiff_t p) const {
    double total = 0;
    for (std::size_t e = 0; e < Count; ++e) {
      total += coefficient[e][p] * x[p - step[e]] + coefficient[e][p + step[e]] * x[p + step[e]];
    }
    return total;
  }
};

/// Calls body(p, (A x)(p)) for all points of the box.
template <std::size_t Count, int Dim, class At, class Body>
void for_each_product(const StencilMatrix<Dim, At>& matrix, const Field<At>& x, const Box<Dim>& where, Body&& body) {
  const Couplings<Count, At> couplings(matrix);
  const double* const value = &x[At{0}];
  const double* const diagonal = &matrix.diagonal[At{0}];
  for_each<At>(matrix.layout, where, [&](At p) { body(p, diagonal[p.n] * value[p.n] + couplings.times(value, p.n)); });
}

/// The same for either stencil.
template <int Dim, class At, class Body>
void visit_products(const StencilMatrix<Dim, At>& matrix, const Field<At>& x, const Box<Dim>& where, Body&& body) {
  constexpr std::size_t star = Dim;
  constexpr std::size_t block = Dim == 2 ? 4 : 13;
  if (matrix.stencil == Stencil::star) {
    for_each_product<star>(matrix, x, where, body);
  } else {
    for_each_product<block>(matrix, x, where, body);
  }
}

/// Couplings of a box stencil along an edge on axis d, from its high end: its own, and half of each that leads away
/// from one of its ends, on the side of the other.
template <int Dim, class At>
struct EdgeSum {
  static constexpr std::size_t slanting = Dim == 2 ? 4 : 16;
  const double* own;
  std::array<const double*, slanting> coefficient;
  std::array<std::ptrdiff_t, slanting> place;  ///< of the coefficient, from the high end

  EdgeSum(const StencilMatrix<Dim, At>& matrix, int d) : own(&matrix.lower[static_cast<std::size_t>(d)][At{0}]) {
    const std::ptrdiff_t to_low = -matrix.layout.step(d).n;
    std::size_t k = 0;
    for (std::size_t e = Dim; e < matrix.offsets.size(); ++e) {
      const int towards = matrix.offsets[e][d];
      if (towards == 0) continue;
      // Couplings of the high end that lead down along d, and of the low end that lead up.
      coefficient[k] = coefficient[k + 1] = &matrix.lower[e][At{0}];
      const std::ptrdiff_t up = matrix.steps[e].n;
      place[k] = towards < 0 ? 0 : up;
      place[k + 1] = to_low + (towards < 0 ? up : 0);
      k += 2;
    }
  }
  double at(std::ptrdiff_t p) const {
    double total = 0;
    for (std::size_t k = 0; k < slanting; ++k) total += coefficient[k][p + place[k]];
    return own[p] + total / 2;
  }
};

template <int Dim>
Step flat_step(const Layout<Dim>& layout, const Index<Dim>& offset) {
  Step step;
  for (int d = 0; d < Dim; ++d) step = step + offset[d] * layout.step(d);
  return step;
}

}  // namespace

template <int Dim>
std::vector<Index<Dim>> lower_offsets(Stencil stencil) {
  std::vector<Index<Dim>> offsets;
  for (int d = 0; d < Dim; ++d) {
    Index<Dim> offset;
    offset[d] = -1;
    offsets.push_back(offset);
  }
  if (stencil == Stencil::star) return offsets;
  int block = 1;
  for (int d = 0; d < Dim; ++d) block *= 3;
  // The first half of the block in the order of flat numbers are the neighbours below, bar those along the axes.
  for (int n = 0; n < block / 2; ++n) {
    Index<Dim> offset;
    int moves = 0;
    for (int d = 0, rest = n; d < Dim; ++d, rest /= 3) {
      offset[d] = rest % 3 - 1;
      moves += offset[d] != 0 ? 1 : 0;
    }
    if (moves > 1) offsets.push_back(offset);
  }
  return offsets;
}

template <int Dim, class At>
StencilMatrix<Dim, At>::StencilMatrix(const Layout<Dim>& layout_in, Stencil stencil_in)
    : layout(layout_in),
      stencil(stencil_in),
      box{Index<Dim>{}, layout_in.cells()},
      offsets(lower_offsets<Dim>(stencil_in)),
      diagonal(layout_in),
      lower(offsets.size(), Field<At>(layout_in)) {
  if constexpr (std::is_same_v<At, Node>) {
    for (int d = 0; d < Dim; ++d) box.hi[d] += layout.periodic(d) ? 0 : 1;
  }
  for (const Index<Dim>& offset : offsets) steps.push_back(-flat_step(layout, offset));
}

template <int Dim, class At>
void StencilMatrix<Dim, At>::wrap_couplings() {
  for (Field<At>& couplings : lower) wrap(layout, box, couplings);
  bool folded = false;
  for (std::size_t e = 0; e < offsets.size(); ++e) {
    Index<Dim> offset = offsets[e];
    for (int d = 0; d < Dim; ++d) offset[d] = layout.image(d, offset[d]) == 0 ? 0 : offset[d];
    if (offset == offsets[e]) continue;
    folded = true;
    fold(e, offset);
  }
  if (!folded) return;
  for (Field<At>& couplings : lower) wrap(layout, box, couplings);
}

template <int Dim, class At>
void StencilMatrix<Dim, At>::fold(std::size_t e, const Index<Dim>& offset) {
  const Step up = flat_step(layout, offset);
  const auto found = std::find_if(steps.begin(), steps.end(), [&](Step s) { return std::abs(s.n) == std::abs(up.n); });
  for_each<At>(layout, box, [&](At p) {
    if (found == steps.end()) {
      diagonal[p] += 2 * lower[e][p];
    } else {
      // The higher of the two points has the coupling.
      lower[static_cast<std::size_t>(found - steps.begin())][p] += lower[e][up.n > 0 ? p - up : p];
    }
  });
  lower[e].fill(0);
}

template <int Dim, class At>
void StencilMatrix<Dim, At>::apply(Field<At>& x, Field<At>& y, const Box<Dim>& where) const {
  wrap(layout, box, x);
  visit_products(*this, x, where, [&](At p, double product) { y[p] = product; });
}

template <int Dim, class At>
void StencilMatrix<Dim, At>::residual(const Field<At>& b, Field<At>& x, Field<At>& r, const Box<Dim>& where) const {
  wrap(layout, box, x);
  visit_products(*this, x, where, [&](At p, double product) { r[p] = b[p] - product; });
}

template <int Dim, class At>
void StencilMatrix<Dim, At>::set_identity(At p) {
  diagonal[p] = 1;
  for (std::size_t e = 0; e < lower.size(); ++e) lower[e][p] = lower[e][layout.image(p + steps[e])] = 0;
}

template <int Dim, class At>
double StencilMatrix<Dim, At>::row_sum(At p) const {
  double total = diagonal[p];
  for (std::size_t e = 0; e < lower.size(); ++e) total += lower[e][p] + lower[e][p + steps[e]];
  return total;
}

template <int Dim, class At>
bool StencilMatrix<Dim, At>::uncoupled(At p) const {
  for (std::size_t e = 0; e < lower.size(); ++e) {
    if (lower[e][p] != 0 || lower[e][p + steps[e]] != 0) return false;
  }
  return true;
}

template <int Dim, class At>
StencilMatrix<Dim, At> star_part(const StencilMatrix<Dim, At>& matrix) {
  if (matrix.stencil == Stencil::star) return matrix;
  const Layout<Dim>& layout = matrix.layout;
  StencilMatrix<Dim, At> star(layout, Stencil::star);
  star.box = matrix.box;
  Field<At, unsigned char> coupled(layout);
  for_each<At>(layout, matrix.box, [&](At p) { coupled[p] = matrix.uncoupled(p) ? 0 : 1; });
  wrap(layout, matrix.box, coupled);
  for (int d = 0; d < Dim; ++d) {
    Box<Dim> inner = matrix.box;
    if (!matrix.wraps(d)) ++inner.lo[d];
    const EdgeSum<Dim, At> couplings(matrix, d);
    const Step along = layout.step(d);
    Field<At>& edge = star.lower[static_cast<std::size_t>(d)];
    for_each<At>(layout, inner, [&](At high) {
      // Between two coupled rows only: identity rows stay identity rows.
      const bool both = coupled[high] != 0 && coupled[high - along] != 0;
      edge[high] = both ? std::min(couplings.at(high.n), 0.0) : 0.0;
    });
  }
  star.wrap_couplings();
  for_each<At>(layout, matrix.box, [&](At p) {
    double diagonal = matrix.row_sum(p);
    for (std::size_t e = 0; e < star.lower.size(); ++e) {
      diagonal -= star.lower[e][p] + star.lower[e][p + star.steps[e]];
    }
    star.diagonal[p] = diagonal;
  });
  return star;
}

template std::vector<Index<2>> lower_offsets<2>(Stencil);
template std::vector<Index<3>> lower_offsets<3>(Stencil);
template struct StencilMatrix<2, Cell>;
template struct StencilMatrix<2, Node>;
template struct StencilMatrix<3, Cell>;
template struct StencilMatrix<3, Node>;
template StencilMatrix<2, Cell> star_part(const StencilMatrix<2, Cell>&);
template StencilMatrix<2, Node> star_part(const StencilMatrix<2, Node>&);
template StencilMatrix<3, Cell> star_part(const StencilMatrix<3, Cell>&);
template StencilMatrix<3, Node> star_part(const StencilMatrix<3, Node>&);

}  // namespace quicksand
