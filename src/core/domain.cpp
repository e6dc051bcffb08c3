#include "core/domain.hpp"

#include <algorithm>

namespace quicksand {

namespace {

/// Factor of a parabolic profile along one axis: 1 where the flow is fastest, 0 at walls that hold it.
/// \param t  place between the axis' ends, 0 to 1
double parabola(double t, bool low_holds, bool high_holds) {
  if (low_holds && high_holds) return 4 * t * (1 - t);
  if (low_holds) return 1 - (1 - t) * (1 - t);
  if (high_holds) return 1 - t * t;
  return 1;
}

/// Ghost cells beyond side s of axis d, corners included.
template <int Dim>
Box<Dim> ghosts_beyond(const Grid<Dim>& grid, int d, int s) {
  Box<Dim> layer = grow(grid.cells(), ghosts);
  (s == 0 ? layer.hi[d] : layer.lo[d]) = s == 0 ? 0 : grid.owned_cells()[d];
  return layer;
}

/// Calls body(d, s) for every side of the kind that this grid reaches.
template <int Dim, class Body>
void for_each_side(const Grid<Dim>& grid, const Sides<Dim>& sides, SideKind kind, Body&& body) {
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (sides.at(d, s).kind == kind && grid.at_boundary(d, s)) body(d, s);
    }
  }
}

}  // namespace

template <int Dim>
SideVelocities<Dim>::SideVelocities(const Grid<Dim>& grid, const Sides<Dim>& sides) : sides_(sides) {
  for (int d = 0; d < Dim; ++d) {
    low_[d] = grid.global_faces(d).front();
    high_[d] = grid.global_faces(d).back();
  }
}

template <int Dim>
bool SideVelocities<Dim>::any() const {
  for (const auto& axis : sides_.side) {
    for (const Side& side : axis) {
      if (!(side.velocity == Vec<3>{})) return true;
    }
  }
  return false;
}

template <int Dim>
Vec<Dim> SideVelocities<Dim>::at(int d, int s, const Vec<Dim>& x) const {
  const Side& side = sides_.at(d, s);
  double factor = 1;
  for (int e = 0; e < Dim && side.profile == Profile::parabolic; ++e) {
    if (e == d) continue;
    const double t = std::clamp((x[e] - low_[e]) / (high_[e] - low_[e]), 0.0, 1.0);
    factor *= parabola(t, sides_.at(e, 0).kind == SideKind::no_slip, sides_.at(e, 1).kind == SideKind::no_slip);
  }
  Vec<Dim> u;
  for (int e = 0; e < Dim; ++e) u[e] = factor * side.velocity[e];
  return u;
}

template <int Dim>
Domain<Dim>::Domain(const Grid<Dim>& g, const Sides<Dim>& s)
    : grid(g.with_periodic(periodic_axes(s))),
      sides(s),
      beyond(grid.layout(), Beyond::nothing),
      side_velocities(grid, sides) {
  for (int d = 0; d < Dim; ++d) {
    const int ends[] = {0, grid.owned_cells()[d]};
    const auto closed = [&](int side) {
      const bool no_face = grid.area(d, shifted(Index<Dim>{}, d, ends[side])) == 0;
      return grid.at_boundary(d, side) && (no_face || !is_passable(sides.at(d, side)));
    };
    if (closed(0)) closed_[d].low = ends[0];
    if (closed(1)) closed_[d].high = ends[1];
  }
  const auto mark = [&](Beyond what) {
    return [this, what](int d, int side) {
      for_each<Cell>(layout(), ghosts_beyond(grid, d, side), [&](Cell c) { beyond[c] = what; });
    };
  };
  for_each_side(grid, sides, SideKind::inflow, mark(Beyond::inflow));
  for_each_side(grid, sides, SideKind::open, mark(Beyond::open));
}

template <int Dim>
Box<Dim> Domain<Dim>::side_faces(int d, int s) const {
  Box<Dim> layer = grow(grid.cells(), 1);
  layer.lo[d] = s == 0 ? 0 : grid.owned_cells()[d];
  layer.hi[d] = layer.lo[d] + (grid.at_boundary(d, s) ? 1 : 0);
  return layer;
}

template <int Dim>
void fill_velocity_ghosts(const Domain<Dim>& domain, CellVectors<Dim>& u) {
  fill_acceleration_ghosts(domain.grid, domain.sides, u);
  // What comes in brings the velocity of its side.
  for_each_side(domain.grid, domain.sides, SideKind::inflow, [&](int d, int s) {
    for_each<Cell>(domain.layout(), ghosts_beyond(domain.grid, d, s), [&](Cell c, const Index<Dim>& i) {
      const Vec<Dim> given = domain.side_velocities.at(d, s, domain.grid.centre(i));
      for (int e = 0; e < Dim; ++e) u[e][c] = given[e];
    });
  });
}

template class SideVelocities<2>;
template class SideVelocities<3>;
template struct Domain<2>;
template struct Domain<3>;
template void fill_velocity_ghosts(const Domain<2>&, CellVectors<2>&);
template void fill_velocity_ghosts(const Domain<3>&, CellVectors<3>&);

}  // namespace quicksand
