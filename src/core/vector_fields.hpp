#pragma once
/// \file
/// Linear combinations of vector fields.
#include "core/field.hpp"
#include "core/loop.hpp"

namespace quicksand {

/// result = a + factor * b on the box; result may be a or b.
template <int Dim, class At>
void add_scaled(const Layout<Dim>& layout, const Box<Dim>& box, const Components<Dim, At>& a, double factor,
                const Components<Dim, At>& b, Components<Dim, At>& result) {
  for (int d = 0; d < Dim; ++d) {
    for_each<At>(layout, box, [&](At p) { result[d][p] = a[d][p] + factor * b[d][p]; });
  }
}

/// result = a + factor * vector on the box, the vector being the same everywhere.
template <int Dim, class At>
void add_uniform(const Layout<Dim>& layout, const Box<Dim>& box, const Components<Dim, At>& a, double factor,
                 const Vec<Dim>& vector, Components<Dim, At>& result) {
  for (int d = 0; d < Dim; ++d) {
    for_each<At>(layout, box, [&](At p) { result[d][p] = a[d][p] + factor * vector[d]; });
  }
}

/// result = factor * (a - b) on the box.
template <int Dim, class At>
void scaled_difference(const Layout<Dim>& layout, const Box<Dim>& box, double factor, const Components<Dim, At>& a,
                       const Components<Dim, At>& b, Components<Dim, At>& result) {
  for (int d = 0; d < Dim; ++d) {
    for_each<At>(layout, box, [&](At p) { result[d][p] = factor * (a[d][p] - b[d][p]); });
  }
}

}  // namespace quicksand
