#pragma once
/// \file
/// The state of a flow: all that a step starts from.
#include "core/domain.hpp"
#include "physics/gas_regions.hpp"
#include "physics/mixture.hpp"

namespace quicksand {

template <int Dim>
struct State {
  Fractions phi;                  ///< volume fractions, per species
  CellVectors<Dim> u;             ///< velocity, cell centred
  NodeField pressure;             ///< P^{n-1/2}
  CellVectors<Dim> acceleration;  ///< (-grad P + div T) / rho - g of the last step: what changed u-bar into u
  GasState gas;                   ///< bubbles
  double time = 0;
  long step = 0;
  double dt = 0;  ///< of the last step

  State(const Layout<Dim>& layout, std::size_t n_species)
      : phi(n_species, CellField(layout)), u(layout), pressure(layout), acceleration(layout), gas(layout) {}
};

}  // namespace quicksand
