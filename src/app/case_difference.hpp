#pragma once
/// \file
/// Whether a run may go on under a case.
#include <optional>
#include <string>

#include "app/case_config.hpp"

namespace quicksand {

/// The first key in which two cases differ, apart from those that a run may be resumed with: the end of the run and
/// its outputs. \returns `KEY was A, is B`, or nothing
std::optional<std::string> difference_that_matters(const CaseConfig& before, const CaseConfig& now);

}  // namespace quicksand
