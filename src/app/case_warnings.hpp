#pragma once
/// \file
/// Things in a case that are allowed but probably not meant. Each warning says what the value is, why that is doubtful
/// and what would be usual.
#include <string>
#include <vector>

#include "app/case_config.hpp"

namespace quicksand {

/// A doubtful value and its key.
struct CaseWarning {
  std::string path;
  std::string message;
};

using CaseWarnings = std::vector<CaseWarning>;

/// All warnings on a case.
CaseWarnings case_warnings(const CaseConfig& config);

/// Warnings as lines `file:line:column: key: message`, with the places of the keys in the file or its settings.
/// \throws InputError as read_case()
std::vector<std::string> located_warnings(const CaseConfig& config, const std::string& file,
                                          const std::vector<std::string>& settings);

/// Adds those on grids: memory, widths of neighbouring cells, and grids around bubbles.
void warn_of_grid(const CaseConfig& config, CaseWarnings& found);
/// Adds those on gravity, species and laws.
void warn_of_physics(const CaseConfig& config, CaseWarnings& found);
/// Adds those on time steps and outputs.
void warn_of_time(const CaseConfig& config, CaseWarnings& found);
/// Adds those on what is filled, and where bubbles and charges are. \pre fits(config)
void warn_of_start(const CaseConfig& config, CaseWarnings& found);

/// Greatest height that liquid could fall from at the start.
double fall_height(const CaseConfig& config);
/// Largest speed of what moves at the start or is moved by sides.
double given_speed(const CaseConfig& config);

}  // namespace quicksand
