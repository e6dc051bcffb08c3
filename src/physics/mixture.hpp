#pragma once
/// \file
/// Fields of the mixture that follow from the volume fractions: density (22), total fraction, liquid region D.
#include <vector>

#include "core/domain.hpp"
#include "physics/species.hpp"

namespace quicksand {

/// Volume fractions phi_i, one field per species.
using Fractions = std::vector<CellField>;

/// Cells with a smaller total fraction count as empty: they bound neither velocity slopes nor the time step.
inline constexpr double empty_fraction = 0.01;

/// total = sum of phi_i in all cells, ghosts included.
template <int Dim>
void sum_fractions(const Grid<Dim>& grid, const Fractions& phi, CellField& total);

/// rho = sum of rho_i phi_i (22), ghosts included.
template <int Dim>
void mix_density(const Grid<Dim>& grid, const std::vector<Species>& species, const Fractions& phi, CellField& rho);

/// Liquid region D = {sum phi >= 1 - eps} (after (20)), ghosts included: mirrored liquid beyond closed sides, gas
/// beyond open ones. \param threshold  eps
template <int Dim>
void mark_liquid(const Grid<Dim>& grid, const CellField& total, double threshold, CellMask& liquid);

}  // namespace quicksand
