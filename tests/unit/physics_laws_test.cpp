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
    rheology(HerschelBulkley{0.6, 0.3, 0.2, 50}),
    rheology(HerschelBulkley{0.6, 0.8, 0, 1000}),
    rheology(HerschelBulkley{0.4, 1, 0.7, 20}),
    rheology(HerschelBulkley{0.4, 1.7, 0.2, 20}),
    rheology(Casson{0.2, 0.3, 40}),
    rheology(Casson{0, 0.3, 400}),
};
const double strain_rates[] = {1e-9, 1e-7, 3e-6, 1e-4, 0.02, 0.3, 5, 400};

TEST(PhysicsLaws, AtRestTheViscosityIsThatOfTheRegularization) {
  for (const Rheology& m : laws) {
    const double a = m.casson_regularization;
    const double power = m.consistency > 0 ? m.consistency * std::pow(m.cutoff, m.index - 1) : 0.0;
    const double expected = m.viscosity + m.yield_stress * m.regularization + power + m.casson_yield_stress * a +
                            m.casson_cross * std::sqrt(a);
    EXPECT_DOUBLE_EQ(effective_viscosity(m, 0), expected);
    EXPECT_DOUBLE_EQ(evaluate(m, 0).f, expected);
    EXPECT_EQ(evaluate(m, 0).potential, 0);
  }
}

TEST(PhysicsLaws, AtLargeStrainRatesTheStressIsYieldStressAndViscosity) {
  for (const Rheology& m : laws) {
    if (m.regularization == 0 || m.consistency > 0) continue;
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

TEST(PhysicsLaws, AtLargeStrainRatesTheStressIsThatOfTheUnregularizedLaw) {
  const double s = 1e5;
  for (const double n : {0.3, 1.0, 1.7}) {
    const double expected = 0.2 + 0.6 * std::pow(s, n);
    EXPECT_NEAR(evaluate(rheology(HerschelBulkley{0.6, n, 0.2, 50}), s).f * s, expected, 1e-12 * expected);
  }
  const double root = std::sqrt(0.3) + std::sqrt(0.2 * s);
  EXPECT_NEAR(evaluate(rheology(Casson{0.2, 0.3, 40}), s).f * s, root * root, 1e-12 * root * root);
}

TEST(PhysicsLaws, CassonsStressIsTheSquareOfAddedRoots) {
  const Rheology m = rheology(Casson{0.2, 0.3, 40});
  for (const double s : strain_rates) {
    const double root = std::sqrt(0.2 * s) - std::sqrt(0.3) * std::expm1(-std::sqrt(40 * s));
    EXPECT_NEAR(evaluate(m, s).f * s, root * root, 1e-13 * root * root);
  }
}

/// Speed on the axis of a tube of radius 1 under the pressure gradient 2: the integral over r of the strain rate at
/// which the stress is r.
double tube_speed(const Rheology& m) {
  constexpr int n = 2000;
  double total = 0;
  for (int i = 0; i < n; ++i) {
    const double stress = (i + 0.5) / n;
    double low = 0;
    double high = 1e3;
    for (int k = 0; k < 100; ++k) {
      const double s = 0.5 * (low + high);
      (evaluate(m, s).f * s < stress ? low : high) = s;
    }
    total += low / n;
  }
  return total;
}

TEST(PhysicsLaws, TheCutoffOfShearThinningDoesNotShowInATube) {
  for (const double n : {0.2, 0.5, 0.8}) {
    const double exact = std::pow(0.5, -1 / n) / (1 / n + 1);
    EXPECT_NEAR(tube_speed(rheology(HerschelBulkley{0.5, n, 0, 100})), exact, 2e-5 * exact) << n;
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
  const Rheology casson = rheology(Casson{0.2, 0.3, 40});
  for (const double x : {1e-3, 0.5}) {
    const LawValue early = evaluate(casson, x * x / 40 * (1 - 1e-13));
    const LawValue late = evaluate(casson, x * x / 40 * (1 + 1e-13));
    expect_meets(early.f, late.f, 1e-12);
    expect_meets(early.slope, late.slope, 1e-9);
    expect_meets(early.potential, late.potential, 1e-11);
  }
}

TEST(PhysicsLaws, StressGrowsWithTheStrainRate) {
  for (const Rheology& m : laws) {
    for (const double s : strain_rates) {
      const LawValue law = evaluate(m, s);
      EXPECT_LE(law.plastic_slope, 0);
      EXPECT_GE(law.slope - law.plastic_slope, 0);
      EXPECT_GE(law.f + law.slope * s, m.viscosity - 1e-12 * law.f);
      if (m.index > 1) continue;
      EXPECT_NEAR(law.plastic, law.f - m.viscosity, 1e-15 * law.f);
    }
  }
}

TEST(PhysicsLaws, LawsAgreeWhereTheyMeet) {
  for (const double s : strain_rates) {
    EXPECT_EQ(evaluate(rheology(Inviscid{}), s).f, 0);
    EXPECT_EQ(evaluate(rheology(Newtonian{2}), s).f, 2);
    EXPECT_EQ(evaluate(rheology(Bingham{2, 3}), s).f, 2);  // the rigid yield stress is apart
    const double bingham = evaluate(rheology(Papanastasiou{2, 3, 100}), s).f;
    EXPECT_NEAR(evaluate(rheology(HerschelBulkley{2, 1, 3, 100}), s).f, bingham, 1e-14 * bingham);
    EXPECT_NEAR(evaluate(rheology(Casson{2, 0, 100}), s).f, 2, 1e-15);
  }
  EXPECT_NEAR(evaluate(rheology(Papanastasiou{2, 3, 100}), 1).f, 5, 1e-12);
  EXPECT_EQ(rheology(Bingham{2, 3}).rigid_yield_stress, 3);
}

TEST(PhysicsLaws, StressesOfAMixtureAddUp) {
  RheologySum sum;
  const Rheology parts[] = {rheology(Papanastasiou{0.1, 0.3, 200}), rheology(HerschelBulkley{0.6, 0.4, 0, 50}),
                            rheology(Casson{0.2, 0.3, 40}), rheology(Newtonian{0.7})};
  for (const Rheology& part : parts) sum.add(part, 0.25, 0.25);
  for (const double s : strain_rates) {
    double f = 0;
    for (const Rheology& part : parts) f += 0.25 * evaluate(part, s).f;
    EXPECT_NEAR(evaluate(sum.result(), s).f, f, 1e-13 * f);
  }
}

TEST(PhysicsLaws, ExponentsOfAMixtureAreMeans) {
  RheologySum sum;
  sum.add(rheology(Papanastasiou{0, 0.3, 200}), 1, 0.5);
  sum.add(rheology(Papanastasiou{0, 0.1, 100}), 1, 0.5);
  sum.add(rheology(HerschelBulkley{2, 0.4, 0, 50}), 0.5, 1);
  sum.add(rheology(HerschelBulkley{1, 0.7, 0, 50}), 0.5, 1);
  sum.add(rheology(Bingham{0, 4}), 0.1, 0.25);
  const Rheology m = sum.result();
  EXPECT_NEAR(m.yield_stress, 0.2, 1e-15);
  EXPECT_NEAR(m.regularization, 175, 1e-12);
  EXPECT_NEAR(m.consistency, 1.5, 1e-15);
  EXPECT_NEAR(m.index, 0.5, 1e-15);
  EXPECT_NEAR(m.rigid_yield_stress, 1, 1e-15);
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
