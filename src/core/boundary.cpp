#include "core/boundary.hpp"

#include <string>

#include "core/errors.hpp"

namespace quicksand {

template <int Dim>
AxisFlags<Dim> periodic_axes(const Sides<Dim>& sides) {
  AxisFlags<Dim> periodic;
  for (int d = 0; d < Dim; ++d) {
    periodic[d] = sides.at(d, 0).kind == SideKind::periodic;
    if (periodic[d] != (sides.at(d, 1).kind == SideKind::periodic)) {
      throw InputError("axis " + std::to_string(d) + " of the domain is periodic at one end only");
    }
  }
  return periodic;
}

template AxisFlags<2> periodic_axes(const Sides<2>&);
template AxisFlags<3> periodic_axes(const Sides<3>&);

GhostRule fraction_rule(const Side& side, std::size_t species) {
  if (!is_passable(side)) return {1, 0};
  return {0, side.outside == species ? 1.0 : 0.0};
}

GhostRule inviscid_velocity_rule(const Side& side, bool normal) {
  if (side.kind == SideKind::inflow) return {0, 0};
  return normal && !is_open(side) ? GhostRule{-1, 0} : GhostRule{1, 0};
}

GhostRule viscous_velocity_rule(const Side& side, bool normal) {
  if (normal) return is_open(side) ? GhostRule{1, 0} : GhostRule{-1, 0};
  const bool sticks = side.kind == SideKind::no_slip || is_passable(side);
  return sticks ? GhostRule{-1, 0} : GhostRule{1, 0};
}

GhostRule potential_rule(const Side& side) { return is_open(side) ? GhostRule{-1, 0} : GhostRule{1, 0}; }

}  // namespace quicksand
