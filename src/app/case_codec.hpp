#pragma once
/// \file
/// The description of a case file, key by key.
#include "app/case_config.hpp"
#include "core/config_codec.hpp"

namespace quicksand {

/// How a whole case is read, written and described.
const Codec<CaseConfig>& case_codec();

/// How a species is read, written and described.
Codec<Species> species_codec();

/// How the sides of the domain are read, written and described.
Codec<Boundaries> boundaries_codec();

/// How the section on outputs is read, written and described.
Codec<OutputSettings> output_codec();

/// How the section on the guard is read, written and described.
Codec<GuardSettings> guard_codec();

/// How a shape is read, written and described.
Codec<Shape> shape_codec();

/// How the case's grid, a stage of a grid sequence and the automatic grids are read, written and described.
Codec<GridConfig> grid_codec();
Codec<StageConfig> stage_codec();
Codec<RegridConfig> regrid_codec();

/// How a bubble, a charge and the treatment of trapped gas are read, written and described.
Codec<InitialBubble> bubble_codec();
Codec<InitialCharge> charge_codec();
Codec<TrappedGas> trapped_gas_codec();

/// The values that the rest of the file depends on, read ahead of it (problems are noted in the full reading).
UnitSystem peek_units(const ConfigNode& root);
int peek_dimension(const ConfigNode& root);

/// Notes what is wrong with values that are each in order but do not fit together.
void check_case(const CaseConfig& config, Reading& reading);

}  // namespace quicksand
