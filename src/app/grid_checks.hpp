#pragma once
/// \file
/// Checks of grids and grid sequences.
#include "app/case_config.hpp"
#include "core/config_codec.hpp"

namespace quicksand {

/// Most cells of a grid: beyond this no machine that this is meant for could hold the fields.
inline constexpr double most_cells = 2e9;

/// Notes what is wrong with the case's grid.
void check_grid(const GridConfig& grid, Reading& reading);

/// Notes what is wrong with the stages of a grid sequence: their order, and that each must fill the case's domain.
void check_stages(const CaseConfig& config, Reading& reading);

}  // namespace quicksand
