#pragma once
/// \file
/// Fractions and what follows from them, for tests of single phases of the time step.
#include "physics/mixture.hpp"
#include "physics/pressure_elements.hpp"
#include "support/grids.hpp"

namespace quicksand::testing {

/// Fractions of some species and what follows from them; call update() after setting owned cells.
template <int Dim>
struct Mixture {
  const Domain<Dim>& domain;
  std::vector<Species> species;
  Fractions phi;
  CellField total, rho;
  CellMask liquid;
  Interfaces<Dim> interfaces;
  PressureElements<Dim> elements;

  Mixture(const Domain<Dim>& d, std::vector<Species> s)
      : domain(d),
        species(std::move(s)),
        phi(species.size(), CellField(d.layout())),
        total(d.layout()),
        rho(d.layout()),
        liquid(d.layout()),
        elements(d.layout()) {}

  void update() {
    for (std::size_t i = 0; i < phi.size(); ++i) fill_fraction_ghosts(domain.grid, domain.sides, i, phi[i]);
    sum_fractions(domain.grid, phi, total);
    mix_density(domain.grid, species, phi, rho);
    mark_liquid(domain.grid, total, 0.5, liquid);
    reconstruct_interfaces(domain.grid, phi, interfaces);
    mark_bearing_cells(domain.grid, total, elements.bears);
    find_pressure_elements(domain, species, phi, total, interfaces, elements);
  }
};

inline Species liquid_species(double density, const Law& law = Inviscid{}) {
  return {.name = "liquid", .density = density, .law = law, .concentration = {}};
}

/// Liquid everywhere.
template <int Dim>
Mixture<Dim> full(const Domain<Dim>& domain, const Species& species) {
  Mixture<Dim> mixture(domain, {species});
  set_cells(domain.grid, mixture.phi[0], [](const Vec<Dim>&) { return 1.0; });
  mixture.update();
  return mixture;
}

/// A ball of liquid in the void with a surface layer of part-filled cells.
template <int Dim>
Mixture<Dim> ball(const Domain<Dim>& domain, const Species& species, const Vec<Dim>& centre, double radius) {
  Mixture<Dim> mixture(domain, {species});
  const double h = domain.grid.smallest_width();
  set_cells(domain.grid, mixture.phi[0],
            [&](const Vec<Dim>& x) { return std::clamp((radius - distance(x, centre)) / h + 0.5, 0.0, 1.0); });
  mixture.update();
  return mixture;
}

}  // namespace quicksand::testing
