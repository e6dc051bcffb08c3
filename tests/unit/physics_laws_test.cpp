#include <gtest/gtest.h>

#include <cmath>

#include "physics/laws.hpp"
#include "physics/stress_elements.hpp"

namespace quicksand {
namespace {

const Rheology laws[] = {
    {},
    {.viscosity = 0.7},
    {.viscosity = 0, .yield_stress = 0.3, .regularization = 200},
    {.viscosity = 0.01, .yield_stress = 2, .regularization = 10},
    {.viscosity = 1, .yield_stress = 5, .regularization = 0},
};
const double strain_rates[] = {1e-9, 1e-7, 3e-6, 1e-4, 0.02, 0.3, 5, 400};

TEST(PhysicsLaws, AtRestTheViscosityIsThatOfTheRegularization) {
  for (const Rheology& m : laws) {
    const double expected = m.viscosity + m.yield_stress * m.regularization;
    EXPECT_DOUBLE_EQ(effective_viscosity(m, 0), expected);
    EXPECT_DOUBLE_EQ(evaluate(m, 0).f, expected);
    EXPECT_EQ(evaluate(m, 0).potential, 0);
  }
}

TEST(PhysicsLaws, AtLargeStrainRatesTheStressIsYieldStressAndViscosity) {
  for (const Rheology& m : laws) {
    if (m.regularization == 0) continue;
    const double s = 1e5;
    EXPECT_NEAR(evaluate(m, s).f * s, m.viscosity * s + m.yield_stress, 1e-12 * (m.viscosity * s + m.yield_stress));
  }
}

TEST(PhysicsLaws, WithoutRegularizationTheLawIsNewtonian) {
  const Rheology m{.viscosity = 1, .yield_stress = 5, .regularization = 0};
  for (const double s : strain_rates) {
    EXPECT_DOUBLE_EQ(evaluate(m, s).f, 1);
    EXPECT_DOUBLE_EQ(evaluate(m, s).potential, 0.5 * s * s);
  }
}

TEST(PhysicsLaws, BothEvaluationsOfTheViscosityAgree) {
  for (const Rheology& m : laws) {
    for (const double s : strain_rates)
      EXPECT_NEAR(evaluate(m, s).f, effective_viscosity(m, s), 1e-13 * (evaluate(m, s).f));
  }
}

TEST(PhysicsLaws, SlopeIsTheDerivativeOfTheViscosity) {
  for (const Rheology& m : laws) {
    for (const double s : {0.001, 0.02, 0.3, 5.0}) {
      const double h = 1e-3 * s;
      // Fourth-order difference.
      const double slope = (8 * (effective_viscosity(m, s + h) - effective_viscosity(m, s - h)) -
                            (effective_viscosity(m, s + 2 * h) - effective_viscosity(m, s - 2 * h))) /
                           (12 * h);
      EXPECT_NEAR(evaluate(m, s).slope, slope, 1e-8 * (1 + std::abs(slope)));
    }
  }
}

TEST(PhysicsLaws, PotentialIsTheIntegralOfTheStress) {
  for (const Rheology& m : laws) {
    for (const double s : strain_rates) {
      // Simpson's rule on a mesh graded towards s = 0.
      constexpr int n = 400;
      double total = 0;
      const auto stress = [&](double t) { return effective_viscosity(m, t) * t; };
      for (int i = 0; i < n; ++i) {
        const double a = s * std::pow(double(i) / n, 3);
        const double b = s * std::pow(double(i + 1) / n, 3);
        total += (b - a) / 6 * (stress(a) + 4 * stress((a + b) / 2) + stress(b));
      }
      EXPECT_NEAR(evaluate(m, s).potential, total, 1e-8 * total);
    }
  }
}

TEST(PhysicsLaws, SeriesAndQuotientMeetWhereTheyChange) {
  const Rheology m{.viscosity = 0, .yield_stress = 0.3, .regularization = 200};
  const auto expect_meets = [](double below, double above, double tolerance) {
    EXPECT_NEAR(below, above, tolerance * std::abs(above));
  };
  const double change = 1e-3 / m.regularization;
  const LawValue below = evaluate(m, change * (1 - 1e-13));
  const LawValue above = evaluate(m, change * (1 + 1e-13));
  expect_meets(below.f, above.f, 1e-12);
  expect_meets(below.potential, above.potential, 1e-10);
  expect_meets(below.slope, above.slope, 1e-9);
  const double early = 1e-5 / m.regularization;
  expect_meets(effective_viscosity(m, early * (1 - 1e-13)), effective_viscosity(m, early * (1 + 1e-13)), 1e-13);
}

TEST(PhysicsLaws, StressGrowsWithTheStrainRate) {
  for (const Rheology& m : laws) {
    for (const double s : strain_rates) {
      const LawValue law = evaluate(m, s);
      EXPECT_LE(law.slope, 0);
      EXPECT_GE(law.f + law.slope * s, m.viscosity - 1e-12 * law.f);
      EXPECT_NEAR(law.plastic, law.f - m.viscosity, 1e-15 * law.f);
    }
  }
}

TEST(PhysicsLaws, EveryLawIsACaseOfTheRegularizedOne) {
  EXPECT_EQ(evaluate(rheology(Inviscid{}), 1).f, 0);
  EXPECT_EQ(evaluate(rheology(Newtonian{2}), 1).f, 2);
  EXPECT_NEAR(evaluate(rheology(Papanastasiou{2, 3, 100}), 1).f, 5, 1e-12);
}

TEST(PhysicsLaws, ConcentrationFactorRunsFromZeroToOne) {
  for (const double kappa : {-3.0, 0.0, 1e-9, 1e-3, 1.0, 5.0}) {
    EXPECT_EQ(concentration_factor(kappa, 0), 0);
    EXPECT_NEAR(concentration_factor(kappa, 1), 1, 1e-15);
    EXPECT_LT(concentration_factor(kappa, 0.4), concentration_factor(kappa, 0.5));
  }
  EXPECT_EQ(concentration_factor(0, 0.3), 0.3);
  EXPECT_NEAR(concentration_factor(1e-8, 0.3), 0.3, 1e-8);
  EXPECT_NEAR(concentration_factor(5, 0.5), (std::exp(2.5) - 1) / (std::exp(5) - 1), 1e-15);
}

}  // namespace
}  // namespace quicksand
