#pragma once
/// \file
/// Redistribution of volume (24)-(27) and momentum (11): what convection packed too densely moves on until the sum of
/// fractions is at most 1; volume and momentum are conserved and kinetic energy can't grow.
#include <vector>

#include "core/domain.hpp"
#include "physics/mixture.hpp"
#include "solvers/linear_solver.hpp"
#include "solvers/obstacle.hpp"

namespace quicksand {

/// H of every species (next step's guess), and what redistribute_volume() leaves for redistribute_momentum().
template <int Dim>
struct RedistributionWork {
  std::vector<CellField> H_species;  ///< H_i of (25)
  CellField H;                       ///< (27)
  /// A = -div grad in finite volumes, for volume; that of a velocity component differs in its diagonal. Made in every
  /// step, since the other phases need the memory more.
  StencilMatrix<Dim, Cell> laplacian;
  double least_density;  ///< cells of lower density are without momentum

  RedistributionWork(const Domain<Dim>& domain, const std::vector<Species>& species);
  /// Frees all but the guesses.
  void release();
};

/// Redistributes the fractions in place, species by species in the order of the successive constraint (24)-(25), and
/// stores H = sum rho_i H_i (27).
/// \param phi      phi~ on entry, phi^{n+1} on return; owned cells
/// \param escaped  volume that leaves through open sides is added, per species
/// \throws NumericalError when an obstacle problem has no solution (full closed box) or is not solved
template <int Dim>
std::vector<ObstacleReport> redistribute_volume(const Domain<Dim>& domain, const std::vector<Species>& species,
                                                const ObstacleOptions& options, RedistributionWork<Dim>& work,
                                                Fractions& phi, std::vector<double>& escaped);

/// Redistributed velocity u-bar of (11): rho^{n+1} u-bar = rho~ u~ + lap(H u-bar).
///
/// With y = H u-bar on {H > 0} the system (V rho / H + A) y = V rho~ u~ is symmetric positive definite; elsewhere u-bar
/// is explicit. A is odd at closed sides that the component is normal to; for the radial component it is that of the
/// vector Laplacian (V / r^2 more).
///
/// \param momentum_tilde  rho~ u~, owned cells
/// \param rho             rho^{n+1}
/// \param u_bar           on return u-bar; 0 in cells below least_density
template <int Dim>
SolveReport redistribute_momentum(const Domain<Dim>& domain, const CellVectors<Dim>& momentum_tilde,
                                  const CellField& rho, const SolveOptions& options, RedistributionWork<Dim>& work,
                                  CellVectors<Dim>& u_bar);

}  // namespace quicksand
