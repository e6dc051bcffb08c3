#pragma once
/// \file
/// Checks of grids and grid sequences.
#include "app/case_config.hpp"
#include "core/config_codec.hpp"

namespace quicksand {

/// Notes what is wrong with the case's grid.
void check_grid(const GridConfig& grid, Reading& reading);

/// Notes what is wrong with the stages of a grid sequence: their order, and that each must fill the case's domain.
void check_stages(const CaseConfig& config, Reading& reading);

}  // namespace quicksand
