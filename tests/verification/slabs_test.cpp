// Two slabs that collide without rebound: common speed (L1 u1 + L2 u2) / (L1 + L2), energy lost L1 L2 (u1 - u2)^2 / (2
// (L1 + L2)).
#include <gtest/gtest.h>

#include <cmath>

#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

constexpr double thickness = 0.02;  // of the row of cells

TEST(CollidingSlabs, GoOnTogetherWithTheExactSpeedAndEnergy) {
  const CaseConfig config = testing::shipped_case("slabs/colliding");
  Flow<2> flow = build_flow<2>(config);
  EXPECT_NEAR(diagnose(flow).kinetic_energy, 0.225 * thickness, 1e-12);
  testing::run(config, flow);
  const Grid<2>& grid = flow.domain().grid;
  const auto largest = [&](double floor, double sign) {
    return maximum<Cell>(grid.layout(), grid.cells(), floor, [&](Cell c) {
      return flow.total()[c] < empty_fraction ? floor : sign * flow.state().u[0][c];
    });
  };
  const double slowest = -largest(-1, -1);
  const double fastest = largest(0, 1);
  testing::expect_absolute({"colliding slabs", "least speed afterwards", "conservation"}, slowest, 0.5, 1e-6);
  testing::expect_absolute({"colliding slabs", "largest speed afterwards", "conservation"}, fastest, 0.5, 1e-6);
  const Diagnostics end = diagnose(flow);
  testing::expect_absolute({"colliding slabs", "energy afterwards", "impact without rebound"},
                           end.kinetic_energy / thickness, 0.075, 1e-6);
  EXPECT_NEAR(end.volume[0], 0.6 * thickness, 1e-14);
}

TEST(CollidingSlabs, KeepTheirMomentumAllTheWay) {
  const CaseConfig config = testing::shipped_case("slabs/colliding");
  Flow<2> flow = build_flow<2>(config);
  const Grid<2>& grid = flow.domain().grid;
  testing::run(config, flow, [&](const StepReport&) {
    const double momentum = sum<Cell>(
        grid.layout(), grid.cells(), [&](Cell c) { return grid.volume(c) * flow.density()[c] * flow.state().u[0][c]; });
    EXPECT_NEAR(momentum, 0.3 * thickness, 1e-10);
    return true;
  });
}

}  // namespace
}  // namespace quicksand
