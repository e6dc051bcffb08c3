#pragma once
/// \file
/// What a case comes to on its first grid, before it runs: memory, and where its species are.
#include <string>
#include <vector>

#include "app/case_config.hpp"
#include "core/field.hpp"
#include "core/grid.hpp"

namespace quicksand {

/// Estimate of the megabytes that a run needs.
double needed_memory(const CaseConfig& config);

/// Megabytes of this machine.
double machine_memory();

/// Whether the grids of the case may be allocated.
bool fits(const CaseConfig& config);

/// The start of a case on the first grid of the run.
template <int Dim>
struct InitialState {
  Grid<Dim> grid;
  std::vector<double> volumes;  ///< per fill
  CellField liquid;             ///< sum of fractions
};

/// \pre config.grid.dimension == Dim and fits(config)
template <int Dim>
InitialState<Dim> fill_cells(const CaseConfig& config);

/// Short text of a number for reading, with four digits.
std::string brief(double value);

}  // namespace quicksand
