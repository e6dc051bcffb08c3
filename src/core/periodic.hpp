#pragma once
/// \file
/// Copies across the ends of periodic axes.
#include "core/field.hpp"
#include "core/loop.hpp"

namespace quicksand {

/// Fills `layers` layers beyond both ends of the periodic axis d with copies, over the extent of `box` along the
/// others.
template <class At, class T, int Dim>
void wrap_axis(const Layout<Dim>& layout, Box<Dim> box, int d, int layers, Field<At, T>& field) {
  for (int s = 0; s < 2; ++s) {
    box.lo[d] = s == 0 ? -layers : layout.cells()[d];
    box.hi[d] = box.lo[d] + layers;
    for_each<At>(layout, box, [&](At p, const Index<Dim>& i) {
      field[p] = field[p + (layout.image(d, i[d]) - i[d]) * layout.step(d)];
    });
  }
}

/// Fills the layers around a box of positions with copies along the axes on which it wraps, corners included. The other
/// positions around it are left alone.
template <class At, class T, int Dim>
void wrap(const Layout<Dim>& layout, Box<Dim> box, Field<At, T>& field, int layers = 1) {
  for (int d = 0; d < Dim; ++d) {
    if (!layout.wraps(box, d)) continue;
    wrap_axis(layout, box, d, layers, field);
    // The next axes fill the corners from these copies.
    box.lo[d] -= layers;
    box.hi[d] += layers;
  }
}

}  // namespace quicksand
