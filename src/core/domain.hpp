#pragma once
/// \file
/// A grid together with what bounds it.
#include "core/boundary.hpp"
#include "core/grid.hpp"

namespace quicksand {

/// Grid, sides and the face areas that liquid can cross.
template <int Dim>
struct Domain {
  Grid<Dim> grid;
  Sides<Dim> sides;
  FaceScalars<Dim> aperture;  ///< face area, zero on closed sides of the domain

  /// The grid becomes periodic where the sides are.
  /// \throws InputError where one side of an axis is periodic and the other is not, or the radius is
  Domain(const Grid<Dim>& g, const Sides<Dim>& s);

  const Layout<Dim>& layout() const { return grid.layout(); }
  /// Layer of faces on side s of axis d (empty where the owned box does not reach the domain's boundary).
  Box<Dim> side_faces(int d, int s) const;
};

extern template struct Domain<2>;
extern template struct Domain<3>;

}  // namespace quicksand
