#pragma once
/// \file
/// Whether the initial shapes of a case make sense.
#include "app/case_config.hpp"
#include "core/config_codec.hpp"

namespace quicksand {

/// Notes fills of unknown species, shapes that are degenerate, reach beyond the grid or overlap, and velocities that
/// the geometry forbids.
void check_initial(const CaseConfig& config, Reading& reading);

/// Notes bubbles that reach beyond the grid, touch a wall or an open side, do not lie in liquid, overlap, or are off
/// the axis of an axisymmetric case.
void check_bubbles(const CaseConfig& config, Reading& reading);

}  // namespace quicksand
