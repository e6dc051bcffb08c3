// Steady flow through a circular tube, report (37)-(41), Fig. 2-4 and Table 1: R = 4, (P_L - P_0) / (2 L) = 1.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "support/figures.hpp"
#include "support/grids.hpp"
#include "support/viscometric.hpp"

namespace quicksand {
namespace {

using testing::StressLaw;

const std::string exact_profile = "exact profile, (39)";
const std::string velocity_error = "error of the velocity (%)";

std::string cells(const std::string& law, int n) { return "tube, " + law + ", " + std::to_string(n) + " cells"; }

constexpr double radius = 4;
constexpr double yield_radius = 2;

/// The shipped case with n cells across the radius, and another law where one is given.
Flow<2> tube(const std::string& name, int n, const std::optional<Law>& law = {}) {
  CaseConfig config = testing::shipped_case("tube/" + name);
  config.grid.x.front().cells = n;
  if (law) config.species.front().law = *law;
  return testing::steady_flow<2>(config);
}

/// Largest error at the cells' centres relative to the largest exact velocity, in per cent.
double largest_error(const Flow<2>& flow, const StressLaw& law) {
  const Grid<2>& grid = flow.domain().grid;
  const double largest = testing::driven_velocity(law, 1, radius, yield_radius, 0);
  double error = 0;
  for (int i = 0; i < grid.owned_cells()[0]; ++i) {
    const double exact = testing::driven_velocity(law, 1, radius, yield_radius, grid.centre_position(0, i));
    for (int j = 0; j < grid.owned_cells()[1]; ++j) {
      error = std::max(error, std::abs(flow.state().u[1][grid.cell({i, j})] - exact));
    }
  }
  return 100 * error / largest;
}

TEST(Tube, ExactProfilesHaveTheKnownSpeeds) {
  // Speeds on the axis and half way out for alpha = 0, 10, 100.
  const auto speed = [](double alpha, double r) {
    return testing::driven_velocity(testing::papanastasiou_law(1, 2, alpha), 1, radius, yield_radius, r);
  };
  EXPECT_NEAR(speed(0, 0), 8, 1e-9);
  EXPECT_NEAR(speed(10, 0), 2.2, 1e-6);
  EXPECT_NEAR(speed(10, 2), 2.04636023, 1e-6);
  EXPECT_NEAR(speed(100, 0), 2.02, 1e-5);
  EXPECT_NEAR(speed(100, 2), 2.00116512, 1e-6);
}

TEST(Tube, NewtonianFlowIsExact) {
  // Report's Table 1: 0.106, 0.0127, 0.00163, 0.00025 %. What is left here is how far from steady the flow still is.
  for (const int n : {4, 8, 16, 32}) {
    testing::expect_at_most({cells("alpha = 0", n), velocity_error, exact_profile},
                            largest_error(tube("tube_newtonian", n), testing::papanastasiou_law(1, 0, 0)), 1e-5);
  }
}

TEST(Tube, YieldStressFlowConverges) {
  // Report's Table 1: 36.26, 13.72, 5.09, 1.76 %.
  const StressLaw law = testing::papanastasiou_law(1, 2, 100);
  const double bound[] = {5, 1, 0.2, 0.025};
  double coarser = 0;
  for (int k = 0; k < 4; ++k) {
    const double error = largest_error(tube("tube_bingham", 4 << k), law);
    const std::string yielding = cells("alpha = 100", 4 << k);
    testing::expect_at_most({yielding, velocity_error, exact_profile}, error, bound[k]);
    if (k > 0) testing::expect_order({yielding, "error of the velocity", exact_profile}, coarser, error, 2);
    coarser = error;
  }
}

TEST(Tube, RigidCoreMovesAsAPlug) {
  // Bingham's law itself (41): v = 2 within r = 2, and Buckingham and Reiner's flow rate.
  const auto exact = [](double r) {
    return r <= yield_radius ? 2.0
                             : 0.5 * radius * radius * (1 - r / radius) * (1 + r / radius - 2 * yield_radius / radius);
  };
  constexpr double exact_rate = 71.20943348;
  double coarser = 0;
  for (const int n : {8, 16, 32}) {
    const Flow<2> flow = tube("tube_bingham", n, Bingham{1, 2});
    const Grid<2>& grid = flow.domain().grid;
    double error = 0;
    double rate = 0;
    double spread = 0;
    const double plug = flow.state().u[1][grid.cell({0, 1})];
    for (int i = 0; i < n; ++i) {
      const double r = grid.centre_position(0, i);
      const double v = flow.state().u[1][grid.cell({i, 1})];
      rate += 2 * std::numbers::pi * r * grid.width_1d(0, i) * v;
      if (r < yield_radius) spread = std::max(spread, std::abs(v - plug));
      if (std::abs(r - yield_radius) > radius / 8) error = std::max(error, std::abs(v - exact(r)));
    }
    EXPECT_LE(spread, 1e-8) << n;
    if (coarser > 0)
      testing::expect_order({cells("Bingham's law", n), "error of the velocity", "(41)"}, coarser, error, 1.9);
    coarser = error;
    if (n < 32) continue;
    testing::expect_relative({cells("Bingham's law", n), "speed of the plug", "(41)"}, plug, 2, 0.002);
    testing::expect_relative({cells("Bingham's law", n), "flow rate", "Buckingham and Reiner"}, rate, exact_rate,
                             0.003);
  }
}

/// Expects errors that fall to second order from 16 to 32 cells and end below `bound` per cent.
void expect_second_order(const std::string& name, const StressLaw& law, double bound) {
  const double coarse = largest_error(tube(name, 16), law);
  const double fine = largest_error(tube(name, 32), law);
  const std::string law_name = name == "tube_casson" ? "Casson" : "Herschel-Bulkley";
  testing::expect_at_most({cells(law_name, 32), velocity_error, exact_profile}, fine, bound);
  testing::expect_order({cells(law_name, 32), "error of the velocity", exact_profile}, coarse, fine, 1.9);
}

TEST(Tube, HerschelBulkleyFlowConverges) {
  expect_second_order(
      "tube_herschel_bulkley", [](double s) { return std::pow(s, 0.6) - 2 * std::expm1(-100 * s); }, 0.1);
}

TEST(Tube, CassonFlowConverges) {
  const auto law = [](double s) {
    const double root = std::sqrt(s) - std::sqrt(2.0) * std::expm1(-std::sqrt(100 * s));
    return root * root;
  };
  expect_second_order("tube_casson", law, 0.2);
}

TEST(Tube, FlowIsTheSameAllAlong) {
  const Flow<2> flow = tube("tube_bingham", 8);
  const Grid<2>& grid = flow.domain().grid;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Cell c = grid.cell({i, j});
      EXPECT_NEAR(flow.state().u[1][c], flow.state().u[1][grid.cell({i, 0})], 1e-12);
      EXPECT_NEAR(flow.state().u[0][c], 0, 1e-12);
      EXPECT_NEAR(flow.total()[c], 1, 1e-12);
    }
  }
  // What came in has left.
  EXPECT_NEAR(flow.escaped()[0], 0, 1e-9);
}

}  // namespace
}  // namespace quicksand
