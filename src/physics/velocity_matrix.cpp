#include "physics/velocity_matrix.hpp"

#include <algorithm>

namespace quicksand {

template <int Dim>
VelocityMatrix<Dim>::VelocityMatrix(const Layout<Dim>& layout)
    : layout_(layout), box_{Index<Dim>{}, layout.cells()}, offsets_(lower_offsets<Dim>(Stencil::box)) {}

template <int Dim>
void VelocityMatrix<Dim>::set_box(const Box<Dim>& box) {
  box_ = box;
  for (StencilMatrix<Dim, Cell>& m : diagonal_) m.box = box;
}

template <int Dim>
void VelocityMatrix<Dim>::clear() {
  if (diagonal_.empty()) {
    diagonal_.assign(at(Dim), StencilMatrix<Dim, Cell>(layout_, Stencil::box));
    cross_centre_.assign(at(Dim * (Dim - 1) / 2), CellField(layout_));
    cross_lower_.resize(at(Dim * Dim));
    for (int a = 0; a < Dim; ++a) {
      for (int b = 0; b < Dim; ++b) {
        if (a != b) cross_lower_[at(a * Dim + b)].assign(offsets().size(), CellField(layout_));
      }
    }
    set_box(box_);
  }
  // One layer more, where apply() reads the couplings of rows around the box.
  const Rows<Dim> rows(layout_, grow(box(), 1));
  std::vector<CellField*> entries;
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      if (b >= a) entries.push_back(&centre(a, b));
      for (std::size_t e = 0; e < offsets().size(); ++e) entries.push_back(&lower(a, b, e));
    }
  }
  const auto zero = [&](std::ptrdiff_t start) {
    for (CellField* const f : entries) std::fill_n(&(*f)[Cell{start}], rows.length, 0.0);
  };
  rows.for_each(zero, static_cast<int>(entries.size()));
}

template <int Dim>
void VelocityMatrix<Dim>::wrap_couplings() {
  for (StencilMatrix<Dim, Cell>& m : diagonal_) m.wrap_couplings();
  for (std::vector<CellField>& couplings : cross_lower_) {
    for (CellField& coupling : couplings) wrap(layout_, box(), coupling);
  }
}

template <int Dim>
void VelocityMatrix<Dim>::apply(CellVectors<Dim>& x, CellVectors<Dim>& y) const {
  const Layout<Dim>& layout = layout_;
  const std::vector<Step>& steps = diagonal_[0].steps;
  for (int a = 0; a < Dim; ++a) diagonal_[at(a)].apply(x[a], y[a]);
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      if (a == b) continue;
      const CellField& here = centre(a, b);
      const CellField& from = x[b];
      CellField& to = y[a];
      for_each<Cell>(layout, box(), [&](Cell c) { to[c] += here[c] * from[c]; });
      for (std::size_t e = 0; e < steps.size(); ++e) {
        const Step s = steps[e];
        const CellField& down = lower(a, b, e);
        const CellField& up = lower(b, a, e);
        for_each<Cell>(layout, box(), [&](Cell c) { to[c] += down[c] * from[c - s] + up[c + s] * from[c + s]; });
      }
    }
  }
}

template class VelocityMatrix<2>;
template class VelocityMatrix<3>;

}  // namespace quicksand
