// The bubble of an explosive charge: (53)-(60) of the report, and the period of its pulsation.
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.hpp"
#include "core/units.hpp"
#include "physics/charge.hpp"

namespace quicksand {
namespace {

constexpr double inch = traditional::foot / 12;

/// The charge of the report's box experiment, 3.5 in deep in fresh water; in a plane spread over 2 in.
constexpr Charge report_charge{2.03e-4, 11.0, 0.272, 1.3};
constexpr double report_pressure = (33.9 + 3.5 / 12) * traditional::foot_of_water;

ExplosionBubble report_cylinder() {
  Charge charge = report_charge;
  charge.mass /= 2 * inch;
  return explosion_bubble(charge, report_pressure, Geometry::planar);
}

TEST(Charge, CylinderOfTheReport) {
  const ExplosionBubble bubble = report_cylinder();
  EXPECT_NEAR(bubble.radius_ratio, 41.567, 5e-4);
  EXPECT_NEAR(bubble.initial_pressure / report_pressure, 580.03, 5e-3);
  EXPECT_NEAR(bubble.minimum_radius / inch, 0.10186, 5e-6);
  EXPECT_NEAR(bubble.maximum_radius / inch, 4.2340, 5e-5);
  EXPECT_NEAR(bubble.least_pressure / report_pressure, 0.03587, 5e-6);
}

TEST(Charge, CylinderObeysTheReportsEquations) {
  const ExplosionBubble bubble = report_cylinder();
  const double m = 2.03e-4 / traditional::pound / (2.0 / 12);  // lb/ft
  const double p = 33.9 + 3.5 / 12;                            // ftH2O
  const double a = bubble.radius_ratio;
  const double q = 2 / std::sqrt(3) * std::pow(0.272, 1.5);
  const double j = 2 / std::sqrt(3) * std::pow(11.0, 1.5);
  EXPECT_NEAR(q, 0.16380, 5e-6);
  EXPECT_NEAR(j, 42.1268, 5e-5);
  EXPECT_NEAR(bubble.minimum_radius / traditional::foot, q * std::sqrt(m), 1e-14);
  const double right = j * std::sqrt((1 - std::pow(a, -0.6)) / (1 - std::pow(a, -2.6))) * std::sqrt(m / p);
  EXPECT_NEAR(bubble.maximum_radius / traditional::foot / right, 1, 1e-13);
  EXPECT_NEAR(bubble.initial_pressure / report_pressure, -0.3 * (1 - a * a) / (1 - std::pow(a, -0.6)), 1e-10);
}

TEST(Charge, BallObeysTheSameBalance) {
  for (const Geometry geometry : {Geometry::cartesian, Geometry::axisymmetric}) {
    const ExplosionBubble bubble = explosion_bubble(report_charge, report_pressure, geometry);
    const double a = bubble.radius_ratio;
    const double m = report_charge.mass / traditional::pound;
    EXPECT_NEAR(a, 12.00, 5e-3);
    EXPECT_NEAR(bubble.minimum_radius / traditional::foot, 0.272 * std::cbrt(m), 1e-14);
    const double right = 11 * std::cbrt((1 - std::pow(a, -0.9)) / (1 - std::pow(a, -3.9)) * m / (33.9 + 3.5 / 12));
    EXPECT_NEAR(bubble.maximum_radius / traditional::foot / right, 1, 1e-13);
    EXPECT_NEAR(bubble.initial_pressure / report_pressure, -0.3 * (1 - a * a * a) / (1 - std::pow(a, -0.9)), 1e-10);
    // (55)
    EXPECT_NEAR(report_cylinder().radius_ratio, std::pow(a, 1.5), 1e-11);
  }
}

TEST(Charge, RootIsFoundForAnyEnergy) {
  // From gas that hardly expands to ratios far beyond those of explosives; the left side of the balance is
  // 1 + P_B0 / ((gamma - 1) P_inf).
  for (const double gamma : {1.05, 1.25, 1.4, 3.0}) {
    for (const double excess : {1e-6, 1e-2, 1.0, 1e3, 1e9}) {
      const double energy = gamma / (gamma - 1) * (1 + excess);
      const Charge charge{1, std::cbrt(energy), 1, gamma};
      const ExplosionBubble b = explosion_bubble(charge, traditional::foot_of_water, Geometry::cartesian);
      EXPECT_GT(b.radius_ratio, 1);
      const double of_gas = b.initial_pressure / traditional::foot_of_water / (gamma - 1);
      EXPECT_NEAR((1 + of_gas) / energy, 1, 1e-9) << gamma << " " << excess;
    }
  }
}

TEST(Charge, RefusesGasThatCannotExpand) {
  EXPECT_THROW(explosion_bubble(report_charge, 0, Geometry::cartesian), InputError);
  EXPECT_THROW(explosion_bubble(report_charge, -1, Geometry::cartesian), InputError);
  // (J / q)^3 = 66143 ftH2O against gamma / (gamma - 1) = 4.33 of them
  const double limit = std::pow(11 / 0.272, 3) * 0.3 / 1.3 * traditional::foot_of_water;
  EXPECT_THROW(explosion_bubble(report_charge, 1.0001 * limit, Geometry::cartesian), InputError);
  EXPECT_NO_THROW(explosion_bubble(report_charge, 0.9999 * limit, Geometry::cartesian));
}

TEST(FreeFieldPeriod, IsThatOfTheRayleighEquation) {
  // Bubbles that start at p0 = 10 and 2 times the pressure around them, gamma = 1.4: largest radii at half a period.
  const struct { double p0, ratio, half; } known[] = {{10, 2.628507, 2.869618}, {2, 1.370652, 1.823644}};
  for (const auto& [p0, ratio, half] : known) {
    constexpr double pressure = traditional::foot_of_water;
    const ExplosionBubble bubble =
        explosion_bubble({1, std::cbrt(1 + p0 / 0.4), 1, 1.4}, pressure, Geometry::cartesian);
    EXPECT_NEAR(bubble.radius_ratio, ratio, 1e-6) << p0;
    EXPECT_NEAR(bubble.initial_pressure / pressure, p0, 1e-12);
    const double scale = bubble.minimum_radius * std::sqrt(1000 / pressure);
    EXPECT_NEAR(free_field_period(bubble, 1.4, pressure, 1000) / scale, 2 * half, 2e-6) << p0;
  }
  // Little gas: twice the collapse of an empty ball.
  const ExplosionBubble deep = explosion_bubble({1, 1e4, 1, 1.4}, traditional::foot_of_water, Geometry::cartesian);
  EXPECT_NEAR(free_field_period(deep, 1.4, traditional::foot_of_water, 1000) /
                  (deep.maximum_radius * std::sqrt(1000 / traditional::foot_of_water)),
              2 * 0.914681, 1e-4);
  // Small oscillations have the period 2 pi R sqrt(rho / (3 gamma p)).
  const double energy = 3.5 * (1 + 1e-4);
  const ExplosionBubble still =
      explosion_bubble({1, std::cbrt(energy), 1, 1.4}, traditional::foot_of_water, Geometry::cartesian);
  EXPECT_NEAR(free_field_period(still, 1.4, traditional::foot_of_water, 1000) /
                  (2 * M_PI * still.minimum_radius * std::sqrt(1000 / (4.2 * traditional::foot_of_water))),
              1, 1e-3);
}

TEST(FreeFieldPeriod, TntFollowsTheLawsOfPractice) {
  // A_max = 12.6 (W / (d + 33))^(1/3) ft and T = 4.36 W^(1/3) / (d + 33)^(5/6) s, W in lb, d in ft. J of (57) is that
  // of the energy, of which the gas keeps a part; so it is greater than 12.6.
  constexpr double pounds = 300;
  const Charge tnt{pounds * traditional::pound, 13.55, 0.268, 1.25};
  for (const double depth : {70.0, 100.0, 140.0, 180.0}) {
    const double head = depth + 33;
    const double p_inf = head * traditional::foot_of_water;
    const ExplosionBubble bubble = explosion_bubble(tnt, p_inf, Geometry::cartesian);
    EXPECT_NEAR(bubble.maximum_radius / traditional::foot / (12.6 * std::cbrt(pounds / head)), 1, 0.01) << depth;
    const double period = free_field_period(bubble, tnt.exponent, p_inf, 1000);
    EXPECT_NEAR(period / (4.36 * std::cbrt(pounds) / std::pow(head, 5.0 / 6)), 1, 0.01) << depth;
  }
}

}  // namespace
}  // namespace quicksand
