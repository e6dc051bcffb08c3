// Small standing waves: omega^2 = g k tanh(k h), and for two layers of depth h that fill a box, densities 2 and 1, a
// third of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/cases.hpp"

namespace quicksand {
namespace {

constexpr double pi = std::numbers::pi;

/// Amplitude of the first mode over time: what the wave's shape projects to of the volume of the first species.
struct Wave {
  std::vector<double> time;
  std::vector<double> amplitude;

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
  for_each_indexed<Cell>(grid.layout(), grid.cells(),
                         [&](Cell c, const Index<2>& i) { weight[c] = grid.volume(c) * mode(grid.centre(i)[0]); });
  const double square =
      sum<Cell>(grid.layout(), grid.cells(), [&](Cell c) { return weight[c] * weight[c] / grid.volume(c); }) /
      (grid.global_faces(1).back() - grid.global_faces(1).front());
  Wave wave;
  testing::run(config, flow, [&](const StepReport&) {
    wave.time.push_back(flow.state().time);
    wave.amplitude.push_back(
        sum<Cell>(grid.layout(), grid.cells(), [&](Cell c) { return weight[c] * flow.state().phi[0][c]; }) / square);
    return true;
  });
  return wave;
}

double plane_mode(double x) { return std::cos(pi * x); }
double tank_mode(double r) { return std::cyl_bessel_j(0.0, 7.6634119404 * r); }

TEST(Sloshing, FirstModeInARectangularTank) {
  const Wave wave = slosh(testing::shipped_case("sloshing/planar"), plane_mode);
  EXPECT_NEAR(wave.frequency() / 1.697445, 1, 0.02);
}

TEST(Sloshing, FirstSymmetricModeInACylindricalTank) {
  const Wave wave = slosh(testing::shipped_case("sloshing/axisymmetric"), tank_mode);
  EXPECT_NEAR(wave.frequency() / 2.766987, 1, 0.02);
}

TEST(Sloshing, FrequencyDoesNotDependOnTheAmplitude) {
  // Larger than a cell, so that the wave crosses rows of cells; theory lowers the frequency by less than a per cent.
  const Wave wave =
      slosh(testing::shipped_case("sloshing/planar", {"initial.0.shape.wave.amplitude=0.05"}), plane_mode);
  EXPECT_NEAR(wave.frequency() / 1.697445, 1, 0.02);
}

TEST(Sloshing, KeepsFourFifthsOfASubCellWaveForTwoPeriods) {
  const Wave wave = slosh(testing::shipped_case("sloshing/planar"), plane_mode);
  const double last = *std::max_element(wave.amplitude.end() - 400, wave.amplitude.end());
  EXPECT_GE(last, 0.8 * wave.amplitude.front());
}

TEST(Sloshing, InternalWaveBetweenTwoLiquidsConvergesToTheExactFrequency) {
  // The displaced mass acts in the middle of cells next to the interface: an error of first order.
  const auto error = [](int cells) {
    const std::string n = std::to_string(cells);
    const Wave wave =
        slosh(testing::shipped_case("sloshing/two_layer", {"grid.x.cells=" + n, "grid.z.cells=" + n}), plane_mode);
    return std::abs(wave.frequency() / 0.980020 - 1);
  };
  const double coarse = error(16);
  const double fine = error(32);
  EXPECT_LE(fine, 0.04);
  EXPECT_GE(std::log2(coarse / fine), 0.7);
}

}  // namespace
}  // namespace quicksand
