#pragma once
/// \file
/// Exact steady shear flows, driven along a tube or channel or by a wall, for any law stress(rate).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/cases.hpp"

namespace quicksand::testing {

/// Shear stress as a growing function of the shear rate.
using StressLaw = std::function<double(double)>;

inline StressLaw papanastasiou_law(double mu, double tau_y, double alpha) {
  return [=](double rate) { return mu * rate - tau_y * std::expm1(-alpha * rate); };
}

/// The rate at which the law has the stress, by bisection.
inline double rate_at(const StressLaw& law, double stress) {
  double low = 0;
  double high = 1;
  while (law(high) < stress) high *= 2;
  for (int k = 0; k < 100 && low < high; ++k) {
    const double middle = 0.5 * (low + high);
    (law(middle) < stress ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Velocity at the distance y from the axis of a flow that sticks at y = half_width: the integral of the rate from y
/// on, with the stress growing as slope * y; report (39).
/// \param kink  where the integrand bends most, lest the quadrature step over it
inline double driven_velocity(const StressLaw& law, double slope, double half_width, double kink, double y) {
  const auto simpson = [&](double a, double b) {
    constexpr int n = 400;
    double total = 0;
    for (int i = 0; i <= n; ++i) {
      const double weight = i == 0 || i == n ? 1 : (i % 2 == 1 ? 4 : 2);
      total += weight * rate_at(law, slope * (a + (b - a) * i / n));
    }
    return total * (b - a) / (3 * n);
  };
  // The rate changes its size within a small part of the way around the kink.
  double velocity = 0;
  double from = y;
  for (const double part : {0.9, 0.98, 1.0, 1.02, 1.1}) {
    const double to = std::min(part * kink, half_width);
    if (to <= from) continue;
    velocity += simpson(from, to);
    from = to;
  }
  return from < half_width ? velocity + simpson(from, half_width) : velocity;
}

/// Runs the case until it is steady, which it must be before its end.
template <int Dim>
Flow<Dim> steady_flow(const CaseConfig& config) {
  Flow<Dim> flow = build_flow<Dim>(config);
  SteadyState steady(config.time.until_steady);
  bool reached = false;
  run(config, flow, [&](const StepReport& report) {
    reached = steady.reached(report, flow.state().time);
    return !reached;
  });
  EXPECT_TRUE(reached) << config.title << ": " << steady.unsteadiness();
  return flow;
}

}  // namespace quicksand::testing
