#include "core/boundary.hpp"

namespace quicksand {

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
