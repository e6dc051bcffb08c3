// The slug of Table 2 of the report: a cylinder of liquid or slurry, radius 1/4 and height 1, collapses in a tank of
// radius 1/2. References are a sharp-interface volume-of-fluid code, for slurries extrapolated from its grids to cell
// width zero, and what the report describes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

/// Height on the axis and radius of the base.
struct Outline {
  double height;
  double radius;
};

struct Slug {
  std::vector<Outline> shape;  ///< at the times asked for
  double last_speed;           ///< of the liquid, at the end
};

/// Runs a case and measures it at some times; the last one is the end.
template <int Dim>
Slug collapse(CaseConfig config, const std::vector<double>& times) {
  config.time.end = times.back();
  config.output.fields = {.every = {}, .times = times};
  Flow<Dim> flow = build_flow<Dim>(config);
  Slug slug{};
  testing::run(config, flow, [&](const StepReport&) {
    const std::size_t next = slug.shape.size();
    if (next < times.size() && flow.state().time >= times[next] - 1e-9) {
      const Diagnostics now = diagnose(flow);
      slug.shape.push_back({now.height_axis, now.radius_base});
      slug.last_speed = now.max_speed_liquid;
    }
    return true;
  });
  return slug;
}

/// A case of the slug at 32 * refinement cells per unit of length, with steps by CFL number.
CaseConfig fast(char letter, int refinement = 1, const std::vector<std::string>& settings = {}) {
  const std::string name = std::string("slug/case_") + letter;
  return testing::refined(testing::with_cfl(testing::shipped_case(name, settings)), refinement);
}

/// The case as it is shipped, with the steps of Table 2.
CaseConfig as_shipped(char letter) { return testing::shipped_case(std::string("slug/case_") + letter); }

void expect_within(double value, double reference, double relative) {
  EXPECT_NEAR(value, reference, relative * reference);
}

const std::string reference = "volume-of-fluid code";
const std::string extrapolated = "volume-of-fluid code, extrapolated to h = 0";

/// What a slurry comes to rest as in the reference.
struct Rest {
  Outline shape;
  double height_bound;
  double radius_bound;
};
constexpr Rest rest_of_d{{0.467, 0.483}, 0.02, 0.03};
constexpr Rest rest_of_e{{0.717, 0.357}, 0.015, 0.03};
/// Bingham's law itself comes to rest higher.
constexpr Rest rigid_rest_of_d{rest_of_d.shape, 0.04, 0.08};
constexpr Rest rigid_rest_of_e{rest_of_e.shape, 0.04, 0.08};

void expect_rest(const std::string& what, const Outline& shape, const Rest& rest) {
  testing::expect_relative({what, "height at rest", extrapolated}, shape.height, rest.shape.height, rest.height_bound);
  testing::expect_relative({what, "radius of the base at rest", extrapolated}, shape.radius, rest.shape.radius,
                           rest.radius_bound);
}

TEST(Slug, ViscousLiquidFallsAsInTheReference) {
  const Slug slug = collapse<2>(fast('b'), {1, 2, 3});
  const std::string b = "slug B, h = 1/32";
  testing::expect_relative({b, "height on the axis at t = 1", reference}, slug.shape[0].height, 0.509, 0.02);
  testing::expect_relative({b, "height on the axis at t = 2", reference}, slug.shape[1].height, 0.126, 0.02);
  testing::expect_relative({b, "height on the axis at t = 3", reference}, slug.shape[2].height, 0.303, 0.02);
}

TEST(Slug, SoftSlurryStopsAsInTheReference) {
  const Slug slug = collapse<2>(fast('d'), {3, 4});
  expect_rest("slug D, h = 1/32", slug.shape[1], rest_of_d);
  expect_within(slug.shape[1].height, slug.shape[0].height, 0.01);
  EXPECT_LE(slug.last_speed, 0.01);
}

TEST(Slug, SandCastleStopsAsInTheReference) {
  const Slug slug = collapse<2>(fast('e'), {3, 4});
  expect_rest("slug E, h = 1/32", slug.shape[1], rest_of_e);
  expect_within(slug.shape[1].height, slug.shape[0].height, 0.01);
  EXPECT_LE(slug.last_speed, 0.01);
  EXPECT_LE(slug.shape[1].radius, 0.4);  // well short of the wall
}

TEST(Slug, StrongSlurryStandsFast) {
  const Slug slug = collapse<2>(fast('f'), {2});
  testing::expect_at_least({"slug F, h = 1/32", "height at t = 2", "the report: it stands"}, slug.shape[0].height,
                           0.98);
  testing::expect_at_most({"slug F, h = 1/32", "radius of the base at t = 2", "the report: it stands"},
                          slug.shape[0].radius, 0.26);
}

TEST(Slug, InviscidLiquidSloshes) {
  const Slug slug = collapse<2>(fast('a'), {2, 3});
  EXPECT_LE(slug.shape[0].height, 0.1);
  EXPECT_GE(slug.shape[1].height, 0.3);  // thrown up on the axis, above the level of rest
}

TEST(Slug, YieldStressOrdersTheHeights) {
  const double b = collapse<2>(fast('b'), {2}).shape[0].height;
  const double d = collapse<2>(fast('d'), {2}).shape[0].height;
  const double e = collapse<2>(fast('e'), {2}).shape[0].height;
  const double f = collapse<2>(fast('f'), {2}).shape[0].height;
  EXPECT_LT(b, d);
  EXPECT_LT(d, e);
  EXPECT_LT(e, f);
}

TEST(Slug, SofterRegularizationCreepsOn) {
  const auto creep = [](char letter) {
    const Slug slug = collapse<2>(fast(letter), {3, 4});
    return slug.shape[0].height - slug.shape[1].height;
  };
  EXPECT_GE(creep('c'), 2 * creep('d'));
}

/// A case with Bingham's law in place of the regularised one.
CaseConfig rigid(CaseConfig config) {
  for (Species& species : config.species) {
    const auto& law = std::get<Papanastasiou>(species.law);
    species.law = Bingham{law.viscosity, law.yield_stress};
  }
  return config;
}

TEST(Slug, RigidSandCastleStopsForGood) {
  const Slug e = collapse<2>(rigid(fast('e')), {3, 3.5});
  expect_rest("slug E, Bingham's law, h = 1/32", e.shape[1], rigid_rest_of_e);
  EXPECT_NEAR(e.shape[1].height, e.shape[0].height, 1e-8);
  testing::expect_at_most({"slug E, Bingham's law, h = 1/32", "speed at t = 3.5", "it stands"}, e.last_speed, 1e-8);
}

TEST(Slug, RigidSlugStandsWithoutMotion) {
  const Slug f = collapse<2>(rigid(fast('f')), {1, 1.2});
  testing::expect_at_least({"slug F, Bingham's law, h = 1/32", "height at t = 1", "it stands"}, f.shape[0].height,
                           0.999);
  EXPECT_NEAR(f.shape[1].height, f.shape[0].height, 1e-9);
  EXPECT_LE(f.last_speed, 1e-8);
}

TEST(Slug, RegularizedSlugCreepsAtASpeedLikeOneOverAlpha) {
  const auto creep = [](const char* alpha) {
    return collapse<2>(fast('f', 1, {std::string("species.0.rheology.regularization=") + alpha}), {1.5}).last_speed;
  };
  const double soft = creep("100");
  const double medium = creep("200");
  const double stiff = creep("400");
  const std::string law = "speed like 1/alpha";
  testing::expect_relative({"slug F, h = 1/32", "creep for alpha = 100 over that for 200", law}, soft / medium, 2,
                           0.15);
  testing::expect_relative({"slug F, h = 1/32", "creep for alpha = 200 over that for 400", law}, medium / stiff, 2,
                           0.15);
}

TEST(Slug, RigidSlurriesStopForGoodSlow) {
  const Slug d = collapse<2>(rigid(fast('d')), {3.5, 4});
  expect_rest("slug D, Bingham's law, h = 1/32", d.shape[1], rigid_rest_of_d);
  // All but a corner cell at its surface, which trembles.
  EXPECT_NEAR(d.shape[1].height, d.shape[0].height, 1e-7);
  EXPECT_LE(d.last_speed, 1e-5);
  EXPECT_LE(collapse<2>(rigid(as_shipped('f')), {1.2}).last_speed, 1e-8);
}

TEST(Slug, NewtonsMethodConvergesInEveryStep) {
  for (const char letter : {'d', 'e'}) {
    const CaseConfig config = fast(letter);
    Flow<2> flow = build_flow<2>(config);
    int steps = 0;
    int iterations = 0;
    testing::run(config, flow, [&](const StepReport& report) {
      EXPECT_TRUE(report.diffusion.converged);
      EXPECT_FALSE(report.diffusion.fell_back);
      EXPECT_FALSE(report.diffusion.stagnated);
      ++steps;
      iterations += report.diffusion.iterations;
      return flow.state().time < 1.5;
    });
    EXPECT_LE(iterations, 4 * steps);
  }
}

TEST(Slug, SlugsStopAsInTheReferenceWithTheStepsOfTheTableSlow) {
  const Slug d = collapse<2>(as_shipped('d'), {4});
  expect_rest("slug D, h = 1/32, steps of Table 2", d.shape[0], rest_of_d);
  const Slug e = collapse<2>(as_shipped('e'), {4});
  expect_rest("slug E, h = 1/32, steps of Table 2", e.shape[0], rest_of_e);
}

TEST(Slug, StepsByCflNumberGiveTheHeightsOfTheTablesStepsSlow) {
  for (const char letter : {'d', 'e'}) {
    const double by_cfl = collapse<2>(fast(letter), {4}).shape[0].height;
    const double by_table = collapse<2>(as_shipped(letter), {4}).shape[0].height;
    testing::expect_relative({std::string("slug ") + letter + ", h = 1/32", "height by CFL number", "steps of Table 2"},
                             by_cfl, by_table, 0.005);
  }
}

TEST(Slug, StrongSlurriesStandFastWithTheStepsOfTheTableSlow) {
  for (const char letter : {'f', 'g'}) {
    const Slug slug = collapse<2>(as_shipped(letter), {2});
    EXPECT_GE(slug.shape[0].height, 0.98);
    EXPECT_LE(slug.shape[0].radius, 0.26);
  }
}

TEST(Slug, FinerGridsStopAsInTheReferenceSlow) {
  const Slug d = collapse<2>(fast('d', 2), {4});
  expect_rest("slug D, h = 1/64", d.shape[0], rest_of_d);
  const Slug e = collapse<2>(fast('e', 2), {4});
  expect_rest("slug E, h = 1/64", e.shape[0], rest_of_e);
}

TEST(Slug, SandCastleHardlyDependsOnTheGridSlow) {
  const double coarse = collapse<2>(fast('e', 1), {4}).shape[0].height;
  const double fine = collapse<2>(fast('e', 4), {4}).shape[0].height;
  testing::expect_relative({"slug E, h = 1/32", "height at rest", "h = 1/128"}, coarse, fine, 0.01);
}

TEST(Slug, LiquidThresholdHardlyMattersSlow) {
  const auto stopped = [](const char* threshold) {
    return collapse<2>(fast('e', 1, {std::string("solver.liquid_threshold=") + threshold}), {4}).shape[0];
  };
  const Outline low = stopped("0.3");
  const Outline high = stopped("0.99");
  expect_within(low.height, high.height, 0.005);
  expect_within(low.radius, high.radius, 0.01);
}

TEST(Slug, SpaceAgreesWithTheTankSlow) {
  const auto compare = [](const std::string& tank_name, const std::string& box_name, double end) {
    CaseConfig tank = testing::with_cfl(testing::shipped_case(tank_name));
    const CaseConfig box = testing::with_cfl(testing::shipped_case(box_name));
    tank.time.end = end;
    const Slug round = collapse<2>(tank, {end});
    const Slug quarter = collapse<3>(box, {end});
    expect_within(quarter.shape[0].height, round.shape[0].height, 0.03);
    expect_within(quarter.shape[0].radius, round.shape[0].radius, 0.03);
  };
  compare("slug/case_b", "slug/case_b_3d", 0.8);
  compare("slug/case_e", "slug/case_e_3d", 4);
}

}  // namespace
}  // namespace quicksand
