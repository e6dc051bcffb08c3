#pragma once
/// \file
/// Kinetic energy of the mixture.
#include "core/domain.hpp"

namespace quicksand {

/// Sum of V |momentum|^2 / (2 rho) over owned cells with mass.
template <int Dim>
double kinetic_energy_of_momentum(const Grid<Dim>& grid, const CellField& rho, const CellVectors<Dim>& momentum) {
  return sum<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    double square = 0;
    for (int d = 0; d < Dim; ++d) square += momentum[d][c] * momentum[d][c];
    return rho[c] > 0 ? 0.5 * grid.volume(i) * square / rho[c] : 0.0;
  });
}

/// Sum of V rho |u|^2 / 2 over owned cells.
template <int Dim>
double kinetic_energy(const Grid<Dim>& grid, const CellField& rho, const CellVectors<Dim>& u) {
  return sum<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    double square = 0;
    for (int d = 0; d < Dim; ++d) square += u[d][c] * u[d][c];
    return 0.5 * grid.volume(i) * rho[c] * square;
  });
}

}  // namespace quicksand
