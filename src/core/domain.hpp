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

/// Grid, sides and what lies beyond them.
template <int Dim>
struct Domain {
  Grid<Dim> grid;
  Sides<Dim> sides;
  Field<Cell, Beyond> beyond;  ///< both ghost layers included
  SideVelocities<Dim> side_velocities;

  /// The grid becomes periodic where the sides are.
  /// \throws InputError where one side of an axis is periodic and the other is not, or the radius is
  Domain(const Grid<Dim>& g, const Sides<Dim>& s);

  const Layout<Dim>& layout() const { return grid.layout(); }
  /// Whether liquid can cross the low face along d of the cell with index i: it can't on closed sides of the
  /// domain and at the axis.
  bool passes(int d, const Index<Dim>& i) const { return i[d] != closed_[d].low && i[d] != closed_[d].high; }
  /// The area that it can cross there, with one ghost layer.
  double aperture(int d, const Index<Dim>& i) const { return passes(d, i) ? grid.area(d, i) : 0.0; }
  /// Layer of faces on side s of axis d (empty where the owned box does not reach the domain's boundary).
  Box<Dim> side_faces(int d, int s) const;

 private:
  /// Where the faces on closed sides of an axis are.
  struct ClosedFaces {
    static constexpr int none = -1 - ghosts;
    int low = none;
    int high = none;
  };
  ClosedFaces closed_[Dim];
};

/// Ghost cells of a velocity for convection and redistribution.
template <int Dim>
void fill_velocity_ghosts(const Domain<Dim>& domain, CellVectors<Dim>& u);

extern template class SideVelocities<2>;
extern template class SideVelocities<3>;
extern template struct Domain<2>;
extern template struct Domain<3>;

}  // namespace quicksand
