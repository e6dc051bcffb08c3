#pragma once
/// \file
/// Whether the initial shapes of a case make sense.
#include <string>

#include "app/case_config.hpp"
#include "core/config_codec.hpp"

namespace quicksand {

/// Notes fills of unknown species, shapes that are degenerate, reach beyond the grid or overlap, and velocities that
/// the geometry forbids.
void check_initial(const CaseConfig& config, Reading& reading);

/// Notes sides of the grid beyond which a shape reaches; it may cross an axis or a plane of symmetry.
void check_inside(const CaseConfig& config, const Shape& shape, const std::string& path, Reading& reading);

}  // namespace quicksand
