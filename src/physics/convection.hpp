#pragma once
/// \file
/// Convection (44): second-order Godunov predictor and conservative update of fractions and momentum.
///
/// Fractions move with planes (surface.hpp). Half-time velocities follow from limited slopes (monotonized central
/// differences, MUSCL-Hancock) and the lagged acceleration. At the border of the liquid region D fluxes are two-sided:
/// what the gas-side cell throws at the liquid enters with its own velocity, however the liquid moves, so that a
/// collision shows as excess density for the redistribution to remove.
#include <vector>

#include "core/domain.hpp"
#include "physics/mixture.hpp"
#include "physics/surface.hpp"

namespace quicksand {

/// What the predictor starts from; all fields with both ghost layers filled.
template <int Dim>
struct ConvectionInput {
  const Fractions& phi;
  const CellField& total;  ///< sum of phi
  const CellField& rho;
  const CellVectors<Dim>& u;
  const CellVectors<Dim>& acceleration;  ///< (-grad P + div T) / rho - g of the last step, one ghost layer
  const CellMask& liquid;                ///< D
  const Interfaces<Dim>& interfaces;     ///< planes of phi
};

/// Normal face velocities at half time from both sides, upwinded into u_mac; also the half-time cell velocities u_half,
/// one ghost layer.
template <int Dim>
void predict_velocities(const Domain<Dim>& domain, const ConvectionInput<Dim>& in, double dt, CellVectors<Dim>& u_half,
                        FaceScalars<Dim>& u_mac);

/// phi~ (44b) and rho~ u~ (44a). Outflow is scaled so that phi~ >= 0.
/// \param u_mac    normal face velocities, divergence-free in D
/// \param escaped  volume that leaves through open sides is added, per species
template <int Dim>
void convect(const Domain<Dim>& domain, const std::vector<Species>& species, const ConvectionInput<Dim>& in, double dt,
             const FaceScalars<Dim>& u_mac, const CellVectors<Dim>& u_half, Fractions& phi_tilde,
             CellVectors<Dim>& momentum_tilde, std::vector<double>& escaped);

}  // namespace quicksand
