#include "core/boundary.hpp"

namespace quicksand {

GhostRule fraction_rule(const Side& side) { return is_open(side) ? GhostRule{0, 0} : GhostRule{1, 0}; }

GhostRule inviscid_velocity_rule(const Side& side, bool normal) {
  return normal && !is_open(side) ? GhostRule{-1, 0} : GhostRule{1, 0};
}

GhostRule viscous_velocity_rule(const Side& side, bool normal) {
  if (normal) return is_open(side) ? GhostRule{1, 0} : GhostRule{-1, 0};
  const bool sticks = side.kind == SideKind::no_slip || is_open(side);
  return sticks ? GhostRule{-1, 0} : GhostRule{1, 0};
}

GhostRule potential_rule(const Side& side) { return is_open(side) ? GhostRule{-1, 0} : GhostRule{1, 0}; }

}  // namespace quicksand
