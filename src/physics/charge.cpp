#include "physics/charge.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "core/errors.hpp"
#include "core/units.hpp"

namespace quicksand {

namespace {

/// v (1 - v^-gamma) / (1 - v^(1-gamma)) at v = exp(log_ratio) > 1.
double energy_of_ratio(double log_ratio, double gamma) {
  return std::exp(log_ratio) * std::expm1(-gamma * log_ratio) / std::expm1((1 - gamma) * log_ratio);
}

/// Logarithm of the volume ratio at which energy_of_ratio() is `energy`. \pre energy > gamma / (gamma - 1)
double solve_ratio(double energy, double gamma) {
  double low = 0;
  double high = std::log(energy);  // the energy of a ratio is greater than the ratio
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return middle;
    (energy_of_ratio(middle, gamma) < energy ? low : high) = middle;
  }
}

/// Points over half a cycle at which the period is integrated; it converges faster than any power of them.
constexpr int period_points = 400;

}  // namespace

ExplosionBubble explosion_bubble(const Charge& charge, double p_inf, Geometry geometry) {
  const double gamma = charge.exponent;
  if (!(p_inf > 0)) {
    std::ostringstream message;
    message << "needs liquid at a pressure above 0 around it, not " << p_inf;
    throw InputError(message.str());
  }
  const double energy =
      std::pow(charge.radius_constant / charge.minimum_radius_constant, 3) / (p_inf / traditional::foot_of_water);
  if (!(energy > gamma / (gamma - 1))) {
    std::ostringstream message;
    message << "would not expand against the pressure " << p_inf << " around it: (J / q)^3 / P_inf is " << energy
            << " and must exceed gamma / (gamma - 1) = " << gamma / (gamma - 1);
    throw InputError(message.str());
  }
  const double log_volumes = solve_ratio(energy, gamma);
  const double q = charge.minimum_radius_constant;
  ExplosionBubble bubble;
  if (geometry == Geometry::planar) {
    const double pounds_per_foot = charge.mass / traditional::pound * traditional::foot;
    bubble.minimum_radius =
        2 / std::numbers::sqrt3 * std::pow(q, 1.5) * std::sqrt(pounds_per_foot) * traditional::foot;  // (53), (54)
    bubble.radius_ratio = std::exp(log_volumes / 2);
  } else {
    bubble.minimum_radius = q * std::cbrt(charge.mass / traditional::pound) * traditional::foot;
    bubble.radius_ratio = std::exp(log_volumes / 3);
  }
  bubble.maximum_radius = bubble.radius_ratio * bubble.minimum_radius;
  bubble.initial_pressure =
      p_inf * (1 - gamma) * std::expm1(log_volumes) / std::expm1((1 - gamma) * log_volumes);  // (58)
  bubble.least_pressure = bubble.initial_pressure * std::exp(-gamma * log_volumes);
  return bubble;
}

double free_field_period(const ExplosionBubble& bubble, double exponent, double p_inf, double density) {
  // With x = R / A_min: x^3 R'^2 = 2 / (3 rho) (P_B0 / (gamma - 1) (1 - x^(3 (1 - gamma))) - P_inf (x^3 - 1)), which
  // vanishes at both ends. With x = ratio^s, s = sin^2(theta / 2) the integrand dR / R' is smooth and periodic in
  // theta.
  const double log_ratio = std::log(bubble.radius_ratio);
  const double step = std::numbers::pi / period_points;
  double half = 0;
  for (int k = 0; k < period_points; ++k) {
    const double theta = (k + 0.5) * step;
    const double log_x = log_ratio * std::pow(std::sin(theta / 2), 2);
    const double work = -bubble.initial_pressure / (exponent - 1) * std::expm1(3 * (1 - exponent) * log_x) -
                        p_inf * std::expm1(3 * log_x);
    const double speed = std::sqrt(2 * work / (3 * density * std::exp(3 * log_x)));
    half += bubble.minimum_radius * std::exp(log_x) * log_ratio * std::sin(theta) / 2 / speed * step;
  }
  return 2 * half;
}

}  // namespace quicksand
