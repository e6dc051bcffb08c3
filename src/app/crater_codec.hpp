#pragma once
/// \file
/// The key `output.crater` of a case file.
#include "app/case_config.hpp"
#include "core/config_codec.hpp"

namespace quicksand {

/// How it is read, written and described.
Codec<CraterSettings> crater_codec();

/// Notes a crater in no species of the case, and a level that is not within the grid.
void check_crater(const CaseConfig& config, Reading& reading);

}  // namespace quicksand
