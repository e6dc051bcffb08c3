#pragma once
/// \file
/// A grid together with what bounds it.
#include "core/boundary.hpp"
#include "core/grid.hpp"

namespace quicksand {

/// What a cell lies beyond: nothing for owned cells and for ghost cells that mirror or continue them.
enum class Beyond : unsigned char {
  nothing,
  open,    ///< an open side, perhaps others as well
  inflow,  ///< an inflow side and no open one
};

/// Velocities of moving walls and inflow sides.
template <int Dim>
class SideVelocities {
 public:
  SideVelocities(const Grid<Dim>& grid, const Sides<Dim>& sides);
  /// Whether any side has a velocity.
  bool any() const;
  /// Velocity of side s of axis d at the point x: of an inflow with its profile, or of a wall.
  Vec<Dim> at(int d, int s, const Vec<Dim>& x) const;

 private:
  Sides<Dim> sides_;
  Vec<Dim> low_, high_;  ///< ends of the domain
};

/// Grid, sides and the face areas that liquid can cross.
template <int Dim>
struct Domain {
  Grid<Dim> grid;
  Sides<Dim> sides;
  FaceScalars<Dim> aperture;   ///< face area, zero on closed sides of the domain
  Field<Cell, Beyond> beyond;  ///< both ghost layers included
  SideVelocities<Dim> side_velocities;

  /// The grid becomes periodic where the sides are.
  /// \throws InputError where one side of an axis is periodic and the other is not, or the radius is
  Domain(const Grid<Dim>& g, const Sides<Dim>& s);

  const Layout<Dim>& layout() const { return grid.layout(); }
  /// Layer of faces on side s of axis d (empty where the owned box does not reach the domain's boundary).
  Box<Dim> side_faces(int d, int s) const;
};

/// Ghost cells of a velocity for convection and redistribution.
template <int Dim>
void fill_velocity_ghosts(const Domain<Dim>& domain, CellVectors<Dim>& u);

extern template class SideVelocities<2>;
extern template class SideVelocities<3>;
extern template struct Domain<2>;
extern template struct Domain<3>;

}  // namespace quicksand
