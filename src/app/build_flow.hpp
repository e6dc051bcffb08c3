#pragma once
/// \file
/// From a case to a flow at time zero.
#include "app/case_config.hpp"
#include "physics/flow.hpp"

namespace quicksand {

/// Parameters and the initial fractions and velocities of a case on a grid with its sides; ready to advance.
/// Where fills share a cell, its velocity is that of their joint momentum.
/// \pre config.grid.dimension == Dim
template <int Dim>
Flow<Dim> build_flow(const CaseConfig& config, Domain<Dim> domain);

/// As above, on the first grid of the case.
template <int Dim>
Flow<Dim> build_flow(const CaseConfig& config);

/// A flow of a case on a grid with its sides, without anything in it. \pre config.grid.dimension == Dim
template <int Dim>
Flow<Dim> empty_flow(const CaseConfig& config, Domain<Dim> domain);

}  // namespace quicksand
