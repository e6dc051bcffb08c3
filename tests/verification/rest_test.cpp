// Liquids at rest stay at rest.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

TEST(Rest, SandUnderWaterDoesNotMove) {
  const CaseConfig config = testing::shipped_case("rest/sand_under_water", {"time.end=20"});
  Flow<2> flow = build_flow<2>(config);
  double fastest = 0;
  testing::run(config, flow, [&](const StepReport&) {
    fastest = std::max(fastest, diagnose(flow).max_speed);
    return flow.state().step < 1000;
  });
  EXPECT_EQ(flow.state().step, 1000);
  testing::expect_at_most({"sand under water at rest", "largest speed in 1000 steps", "0"}, fastest, 1e-10);
}

/// A layer of water whose surface lies inside the 17th row of cells, which is filled to `level`.
void expect_calm_below(double level) {
  SCOPED_TRACE(level);
  const std::string top = std::to_string(0.5 + level / 32);
  const CaseConfig config =
      testing::shipped_case("rest/sand_under_water", {"time.end=5", "initial.1.shape.layer.top=" + top});
  Flow<2> flow = build_flow<2>(config);
  const Grid<2>& grid = flow.domain().grid;
  Box<2> below = grid.cells();
  below.hi[1] = 15;
  double fastest = 0;
  testing::run(config, flow, [&](const StepReport&) {
    for (int d = 0; d < 2; ++d) {
      fastest = maximum<Cell>(grid.layout(), below, fastest, [&](Cell c) { return std::abs(flow.state().u[d][c]); });
    }
    return true;
  });
  testing::expect_at_most({"layer that ends at " + std::to_string(level).substr(0, 3) + " of a cell",
                           "largest speed below the surface", "0"},
                          fastest, 1e-6);
}

TEST(Rest, LiquidBelowASurfaceInsideACellStaysCalm) {
  for (const double level : {0.2, 0.5, 0.7}) expect_calm_below(level);
}

}  // namespace
}  // namespace quicksand
