#pragma once
/// \file
/// The description of a case file, key by key.
#include "app/case_config.hpp"
#include "core/config_codec.hpp"

namespace quicksand {

/// How a whole case is read, written and described.
const Codec<CaseConfig>& case_codec();

/// How the section on outputs is read, written and described.
Codec<OutputSettings> output_codec();

/// How the section on the guard is read, written and described.
Codec<GuardSettings> guard_codec();

/// How a shape is read, written and described.
Codec<Shape> shape_codec();

/// The values that the rest of the file depends on, read ahead of it (problems are noted in the full reading).
UnitSystem peek_units(const ConfigNode& root);
int peek_dimension(const ConfigNode& root);

/// Notes what is wrong with values that are each in order but do not fit together.
void check_case(const CaseConfig& config, Reading& reading);

}  // namespace quicksand
