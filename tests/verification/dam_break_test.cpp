// A column of water, width 1 and height 2, set free to run out over a dry floor (Martin and Moyce 1952).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

const std::string dam = "broken dam, 32 cells";
const std::string experiment = "Martin and Moyce 1952";

/// The front's place and the energy at some times.
struct DamBreak {
  std::vector<double> front;
  std::vector<double> energy;
};

DamBreak break_dam(std::vector<double> times) {
  CaseConfig config = testing::shipped_case("dam_break/martin_moyce");
  config.time.end = times.back();
  config.output.fields = {.every = {}, .times = times};
  Flow<2> flow = build_flow<2>(config);
  DamBreak result;
  std::size_t next = 0;
  testing::run(config, flow, [&](const StepReport&) {
    if (next < times.size() && flow.state().time >= times[next] - 1e-9) {
      const Diagnostics now = diagnose(flow);
      result.front.push_back(now.radius_base);
      result.energy.push_back(now.kinetic_energy + now.potential_energy);
      ++next;
    }
    return true;
  });
  return result;
}

/// Acceleration of the column's face at a height above the floor, in the first instant: with p = 0 on the face and the
/// top the pressure is harmonic, and its gradient on the face is sum tanh(k) / k cos(k y), k = (n + 1/2) pi / 2.
double initial_acceleration(double y) {
  double total = 0;
  for (int n = 0; n < 20000; ++n) {
    const double k = (n + 0.5) * std::numbers::pi / 2;
    total += std::tanh(k) / k * std::cos(k * y);
  }
  return total;
}

TEST(DamBreak, FrontStartsWithTheExactAcceleration) {
  constexpr double row_centre = 1.0 / 64;
  const DamBreak flow = break_dam({0.1, 0.2, 0.29});
  const double a = initial_acceleration(row_centre);
  const std::string source = "exact first acceleration";
  testing::expect_absolute({dam, "way of the front at t = 0.2", source}, flow.front[1] - 1, 0.5 * a * 0.2 * 0.2, 0.01);
  testing::expect_absolute({dam, "way of the front at t = 0.29", source}, flow.front[2] - 1, 0.5 * a * 0.29 * 0.29,
                           0.01);
}

TEST(DamBreak, EnergyIsKeptWhileTheWaterRunsOut) {
  const DamBreak flow = break_dam({0.5, 1.0, 1.5});
  testing::expect_relative({dam, "energy at t = 0.5", "kept"}, flow.energy[0], 2, 2e-3);
  testing::expect_relative({dam, "energy at t = 1", "kept"}, flow.energy[1], 2, 2e-3);
  testing::expect_relative({dam, "energy at t = 1.5", "kept"}, flow.energy[2], 2, 2e-3);
}

TEST(DamBreak, FrontRunsAtTheMeasuredSpeed) {
  // Mean speed between rows of the table: the measured front lags in time behind a column set free at once.
  const double scale = std::sqrt(2.0);
  const DamBreak flow = break_dam({1.63 / scale, 1.98 / scale, 2.32 / scale, 2.65 / scale});
  testing::expect_relative({dam, "way of the front from T = 1.63 to 2.65", experiment}, flow.front[3] - flow.front[0],
                           3.22 - 1.89, 0.06);
  testing::expect_relative({dam, "way of the front from T = 1.63 to 2.32", experiment}, flow.front[2] - flow.front[0],
                           2.78 - 1.89, 0.06);
}

TEST(DamBreak, FrontFollowsTheTableOnceReleased) {
  // The experiment's column is let go by a diaphragm: from the row Z = 1.22 on its front is that of a column set free
  // at once, later by one delay.
  const double scale = std::sqrt(2.0);
  const std::vector<double> table_time = {1.19, 1.43, 1.63, 1.98, 2.32, 2.65};
  const std::vector<double> table_front = {1.44, 1.67, 1.89, 2.33, 2.78, 3.22};
  constexpr double delay = 0.27;
  std::vector<double> times;
  for (const double t : table_time) times.push_back((t - delay) / scale);
  const DamBreak flow = break_dam(times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    std::ostringstream quantity;
    quantity << "front at T = " << table_time[i] << ", 0.27 of it for letting go";
    testing::expect_relative({dam, quantity.str(), experiment}, flow.front[i], table_front[i], 0.03);
  }
}

}  // namespace
}  // namespace quicksand
