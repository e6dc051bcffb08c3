#pragma once
/// \file
/// Volume cut from a unit cube by a plane (Scardovelli and Zaleski, J. Comput. Phys. 164, 2000).
#include <algorithm>
#include <cmath>

#include "core/index.hpp"

namespace quicksand {

/// Part of the unit cube where m1 x1 + m2 x2 + m3 x3 <= alpha, for m >= 0 that sum to 1.
inline double cube_fraction(double a, double b, double c, double alpha) {
  if (alpha <= 0) return 0;
  if (alpha >= 1) return 1;
  const bool upper_half = alpha > 0.5;
  const double t = upper_half ? 1 - alpha : alpha;
  const double m1 = std::min({a, b, c});
  const double m3 = std::max({a, b, c});
  const double m2 = std::max(1 - m1 - m3, m1);
  const double m12 = m1 + m2;
  const double product = 6 * m1 * m2 * m3;
  double v = 0;
  if (t < m1) {
    v = t * t * t / product;
  } else if (t < m2) {
    v = (t * (t - m1) + m1 * m1 / 3) / (2 * m2 * m3);
  } else if (t < std::min(m12, m3)) {
    v = m1 < 1e-9 ? (t - m12 / 2) / m3
                  : (t * t * (3 * m12 - t) + m1 * m1 * (m1 - 3 * t) + m2 * m2 * (m2 - 3 * t)) / product;
  } else if (m12 <= m3) {
    v = (t - m12 / 2) / m3;
  } else {
    v = (t * t * (3 - 2 * t) + m1 * m1 * (m1 - 3 * t) + m2 * m2 * (m2 - 3 * t) + m3 * m3 * (m3 - 3 * t)) / product;
  }
  v = std::clamp(v, 0.0, 0.5);
  return upper_half ? 1 - v : v;
}

/// cube_fraction() in two or three dimensions; m need not be normalised.
template <int Dim>
double cut_fraction(const Vec<Dim>& m, double alpha) {
  double norm = 0;
  for (int d = 0; d < Dim; ++d) norm += m[d];
  if (!(norm > 0)) return alpha > 0 ? 1 : 0;
  return cube_fraction(m[0] / norm, m[1] / norm, Dim == 3 ? m[Dim - 1] / norm : 0.0, alpha / norm);
}

/// Where an increasing function passes zero, to round-off, by bracketed secant steps.
///
/// \param error      the function
/// \param low, high  bracket, with the function's values there
/// \param start      first guess
template <class Error>
double rising_root(Error&& error, double low, double high, double low_error, double high_error, double start) {
  double x = start;
  for (int k = 0; k < 60; ++k) {
    const double at_x = error(x);
    if (std::abs(at_x) < 1e-14) break;
    if (at_x < 0) {
      low = x;
      low_error = at_x;
    } else {
      high = x;
      high_error = at_x;
    }
    // Every third step halves the bracket, where the secant would creep.
    const double secant = low + (high - low) * low_error / (low_error - high_error);
    x = k % 3 == 2 ? 0.5 * (low + high) : secant;
  }
  return x;
}

/// The alpha for which cut_fraction(m, alpha) = fraction, to round-off.
template <int Dim>
double plane_offset(const Vec<Dim>& m, double fraction) {
  double norm = 0;
  for (int d = 0; d < Dim; ++d) norm += m[d];
  return rising_root([&](double alpha) { return cut_fraction(m, alpha) - fraction; }, 0.0, norm, -fraction,
                     1 - fraction, fraction * norm);
}

}  // namespace quicksand
