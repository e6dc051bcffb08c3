#pragma once
/// \file
/// What `quicksand check` and `quicksand info` print.
#include <string>

#include "app/case_config.hpp"

namespace quicksand {

/// A case in numbers: grid, memory, species and their volumes, time steps, output.
std::string case_report(const CaseConfig& config);

/// What a result folder or a field file holds.
/// \throws FileError if there is none
std::string result_report(const std::string& path);

}  // namespace quicksand
