#pragma once
/// \file
/// Explosive charges: the bubble of gas that one leaves, by the empirical laws of the report, (53)-(60).
#include "core/grid.hpp"

namespace quicksand {

/// A charge. The constants of explosives are listed in traditional units (feet, pounds, feet of water), whatever the
/// units of the case are.
struct Charge {
  double mass = 0;                     ///< W, kg; in planar flows M, kg/m: mass per length across the plane
  double radius_constant = 0;          ///< J, ft (ftH2O / lb)^(1/3)
  double minimum_radius_constant = 0;  ///< q, ft / lb^(1/3)
  double exponent = 1.4;               ///< gamma of the gas
};

/// The bubble of a charge, SI.
struct ExplosionBubble {
  double radius_ratio = 1;      ///< A_max / A_min, (55)
  double minimum_radius = 0;    ///< A_min, (53): where it starts, at rest
  double maximum_radius = 0;    ///< A_max, (57): what it would reach in unbounded liquid
  double initial_pressure = 0;  ///< P_B0, (58)
  double least_pressure = 0;    ///< of the gas at the maximum radius
};

/// The bubble of a charge in liquid at the pressure P_inf.
///
/// The report's laws are those of a cylinder of gas in a planar flow; its constants (54), (56) follow from those of a
/// ball by equal volumes per mass of charge. With n = 2 for the cylinder, n = 3 for the ball, and the volume ratio
/// v = (A_max / A_min)^n, (53)-(57) read in both
///     A_min = q_n M^(1/n),   v (1 - v^-gamma) / (1 - v^(1-gamma)) = (J / q)^3 / P_inf,
/// where q_3 = q and q_2 = 2 / sqrt(3) q^(3/2). The left side is 1 + P_B0 / ((gamma - 1) P_inf): the gas and the liquid
/// that it displaces hold the energy of the charge. It grows with v from gamma / (gamma - 1) at v = 1, so that there is
/// one root, found by bisection to round-off.
/// \param geometry  planar: a cylinder, n = 2; else a ball
/// \param p_inf     Pa
/// \throws InputError if P_inf is not positive or so great that the gas could not expand
ExplosionBubble explosion_bubble(const Charge& charge, double p_inf, Geometry geometry);

/// Time from the start to the next minimum of a ball in unbounded liquid without gravity:
///     rho (R R'' + 3/2 R'^2) = P_B - P_inf,   P_B = P_B0 (A_min / R)^(3 gamma),
/// whose first integral, the energy, is integrated over half a cycle. (A cylinder in unbounded liquid has no period.)
/// \param exponent  gamma
/// \param p_inf     pressure far away, Pa
/// \param density   of the liquid, kg/m^3
double free_field_period(const ExplosionBubble& bubble, double exponent, double p_inf, double density);

}  // namespace quicksand
