#pragma once
/// \file
/// Bingham's yield stress (35) at one stress point, without regularisation.
///
/// tau_y s is the greatest <p, Delta> over stresses |p| <= tau_y, <a, b> = 1/2 a:b. The method of multipliers holds an
/// estimate p and adds -|q - p|^2 / (2 r) to <q, Delta>: the greatest value is smooth in Delta and belongs to
/// q = P(p + r Delta), P the projection onto |q| <= tau_y. Where p is the true stress, so is q, for any penalty r > 0,
/// and a rigid material does not strain at all.
#include <algorithm>
#include <cmath>

#include "physics/element_shape.hpp"

namespace quicksand {

/// a + scale b, with its norm as `scalar`.
template <int Dim>
StrainRate<Dim> add_scaled(const StrainRate<Dim>& a, double scale, const StrainRate<Dim>& b) {
  StrainRate<Dim> y;
  y.third = a.third + scale * b.third;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) y.delta[i][j] = a.delta[i][j] + scale * b.delta[i][j];
  }
  y.scalar = std::sqrt(inner(y, y));
  return y;
}

/// Scales a tensor down until its norm is at most `largest`.
template <int Dim>
void limit(StrainRate<Dim>& stress, double largest) {
  const double size = std::sqrt(inner(stress, stress));
  stress.scalar = std::min(size, largest);
  if (!(size > largest)) return;
  const double scale = largest / size;
  stress.third *= scale;
  for (auto& row : stress.delta) {
    for (double& t : row) t *= scale;
  }
}

/// Whether a stress is below the yield stress by more than round-off.
template <int Dim>
bool is_rigid(const StrainRate<Dim>& stress, double yield_stress) {
  return std::sqrt(inner(stress, stress)) < (1 - 1e-9) * yield_stress;
}

/// The penalised yield stress at one strain rate.
template <int Dim>
struct RigidYield {
  StrainRate<Dim> stress;  ///< q
  StrainRate<Dim> driver;  ///< p / r + Delta; q = f driver
  double f;                ///< r where rigid, less where it yields
  double slope;            ///< df / d|driver|
  double potential;        ///< <q, Delta> - |q - p|^2 / (2 r)
  double gap;              ///< tau_y s - <q, Delta> >= 0; 0 where q is the stress that belongs to Delta

  /// \param p        |p| <= yield_stress for penalty > 0
  /// \param penalty  r; 0 keeps q = p
  RigidYield(const StrainRate<Dim>& p, double yield_stress, double penalty, const StrainRate<Dim>& s)
      : stress(add_scaled(p, penalty, s)), driver{}, f(penalty), slope(0), potential(0), gap(0) {
    const double along = inner(p, s);
    const double size = stress.scalar;
    if (penalty > 0) driver = add_scaled(s, 1 / penalty, p);
    if (penalty > 0 && size > yield_stress) {
      f = penalty * yield_stress / size;
      slope = -penalty * f / size;
      limit(stress, yield_stress);
      // (tau_y |p + r Delta| - tau_y^2 / 2 - |p|^2 / 2) / r
      const double beyond = size - yield_stress;
      potential = along + 0.5 * penalty * s.scalar * s.scalar - 0.5 * beyond * beyond / penalty;
    } else {
      potential = along + 0.5 * penalty * s.scalar * s.scalar;
    }
    gap = std::max(0.0, yield_stress * s.scalar - inner(stress, s));
  }
};

}  // namespace quicksand
