// Small standing waves: omega^2 = g k tanh(k h), and for two layers of depth h that fill a box, densities 2 and 1, a
// third of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

constexpr double pi = std::numbers::pi;
const std::string theory = "linear theory";
const std::string lossless = "1, linear theory";

/// Amplitude of the first mode over time: what the wave's shape projects to of the volume of the first species.
struct Wave {
  std::vector<double> time;
  std::vector<double> amplitude;
  double top_speed = 0;

  /// From the times at which the amplitude changes sign: they lie half a period apart.
  double frequency() const {
    std::vector<double> zeros;
    for (std::size_t i = 1; i < time.size(); ++i) {
      if (amplitude[i - 1] * amplitude[i] < 0) {
        const double t = amplitude[i - 1] / (amplitude[i - 1] - amplitude[i]);
        zeros.push_back((1 - t) * time[i - 1] + t * time[i]);
      }
    }
    if (zeros.size() < 2) return 0;
    return pi * static_cast<double>(zeros.size() - 1) / (zeros.back() - zeros.front());
  }
};

template <class Mode>
Wave slosh(const CaseConfig& config, Mode&& mode) {
  Flow<2> flow = build_flow<2>(config);
  const Grid<2>& grid = flow.domain().grid;
  CellField weight(grid.layout());
  for_each<Cell>(grid.layout(), grid.cells(),
                 [&](Cell c, const Index<2>& i) { weight[c] = grid.volume(c) * mode(grid.centre(i)[0]); });
  const double square =
      sum<Cell>(grid.layout(), grid.cells(), [&](Cell c) { return weight[c] * weight[c] / grid.volume(c); }) /
      (grid.global_faces(1).back() - grid.global_faces(1).front());
  Wave wave;
  testing::run(config, flow, [&](const StepReport&) {
    wave.time.push_back(flow.state().time);
    wave.amplitude.push_back(
        sum<Cell>(grid.layout(), grid.cells(), [&](Cell c) { return weight[c] * flow.state().phi[0][c]; }) / square);
    wave.top_speed = std::max(wave.top_speed, diagnose(flow).max_speed);
    return true;
  });
  return wave;
}

double plane_mode(double x) { return std::cos(pi * x); }
double tank_mode(double r) { return std::cyl_bessel_j(0.0, 7.6634119404 * r); }

TEST(Sloshing, FirstModeInARectangularTank) {
  const Wave wave = slosh(testing::shipped_case("sloshing/planar"), plane_mode);
  testing::expect_relative({"rectangular tank, 32 cells", "frequency", theory}, wave.frequency(), 1.697445, 0.01);
}

TEST(Sloshing, FirstSymmetricModeInACylindricalTank) {
  const Wave wave = slosh(testing::shipped_case("sloshing/axisymmetric"), tank_mode);
  testing::expect_relative({"cylindrical tank, 32 cells", "frequency", theory}, wave.frequency(), 2.766987, 0.01);
}

TEST(Sloshing, FrequencyDoesNotDependOnTheAmplitude) {
  // Larger than a cell, so that the wave crosses rows of cells; theory lowers the frequency by less than a per cent.
  const Wave wave =
      slosh(testing::shipped_case("sloshing/planar", {"initial.0.shape.wave.amplitude=0.05"}), plane_mode);
  testing::expect_relative({"rectangular tank, amplitude 0.05", "frequency", theory}, wave.frequency(), 1.697445, 0.01);
}

/// Part of its amplitude that a wave has at the end, the end of its second period or shortly before.
double kept(const Wave& wave) {
  return *std::max_element(wave.amplitude.end() - 400, wave.amplitude.end()) / wave.amplitude.front();
}

TEST(Sloshing, KeepsASubCellWaveForTwoPeriods) {
  const auto wave = [](int cells) {
    return slosh(testing::shipped_case("sloshing/planar", {"time.end=7.6", "grid.x.cells=" + std::to_string(cells),
                                                           "grid.z.cells=" + std::to_string(3 * cells / 4)}),
                 plane_mode);
  };
  const std::string part = "part of the amplitude after two periods";
  testing::expect_at_least({"rectangular tank, 16 cells", part, lossless}, kept(wave(16)), 0.93);
  testing::expect_at_least({"rectangular tank, 32 cells", part, lossless}, kept(wave(32)), 0.94);
}

TEST(Sloshing, KeepsASubCellWaveInACylindricalTank) {
  testing::expect_at_least({"cylindrical tank, 32 cells", "part of the amplitude after two periods", lossless},
                           kept(slosh(testing::shipped_case("sloshing/axisymmetric", {"time.end=4.7"}), tank_mode)),
                           0.92);
}

TEST(Sloshing, InternalWaveBetweenTwoLiquidsHasTheExactFrequencyWithoutAJet) {
  for (const int cells : {16, 32}) {
    const std::string n = std::to_string(cells);
    const CaseConfig config = testing::shipped_case("sloshing/two_layer", {"grid.x.cells=" + n, "grid.z.cells=" + n});
    const Wave wave = slosh(config, plane_mode);
    testing::expect_relative({"two layers, " + n + " cells", "frequency", theory}, wave.frequency(), 0.980020, 0.01);
    // The wave itself has the speed 0.0098 (amplitude times frequency) at the walls.
    testing::expect_at_most({"two layers, " + n + " cells", "largest speed", "0.0098, linear theory"}, wave.top_speed,
                            0.012);
  }
}

}  // namespace
}  // namespace quicksand
