#pragma once
/// \file
/// Whether the bubbles and charges of a case make sense.
#include "app/case_config.hpp"
#include "core/config_codec.hpp"

namespace quicksand {

/// Notes bubbles, and first bubbles of charges, that reach beyond the grid, touch a wall or an open side, cross a plane
/// of symmetry without being centred on it, do not lie in liquid, overlap, or are off the axis of an axisymmetric case;
/// and charges in nondimensional cases, without a thickness where one is needed or with one where there is none, or
/// whose gas could not expand.
void check_bubbles(const CaseConfig& config, Reading& reading);

}  // namespace quicksand
