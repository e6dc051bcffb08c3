// Lid-driven cavity without inertia: place and flow of the vortex against published values (Mitsoulis and Zisis 2001,
// Syrakos, Georgiou and Alexandrou 2013, and others who agree with them), yield stress Bn for unit speed, side and
// viscosity.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/stress.hpp"
#include "support/viscometric.hpp"

namespace quicksand {
namespace {

/// The vortex: largest stream function and the height where it is.
struct Vortex {
  double flow = 0;
  double height = 0;
};

/// Integrates the velocity upwards in every column of cells; the largest value is that of a parabola through three.
Vortex find_vortex(const Flow<2>& flow) {
  const Grid<2>& grid = flow.domain().grid;
  const int n = grid.owned_cells()[1];
  Vortex vortex;
  for (int i = 0; i < grid.owned_cells()[0]; ++i) {
    std::vector<double> psi{0};
    for (int j = 0; j < n; ++j) {
      psi.push_back(psi.back() - flow.state().u[0][grid.cell({i, j})] * grid.width_1d(1, j));
    }
    for (std::size_t j = 1; j + 1 < psi.size(); ++j) {
      if (!(psi[j] > psi[j - 1] && psi[j] >= psi[j + 1])) continue;
      const double shift = 0.5 * (psi[j - 1] - psi[j + 1]) / (psi[j - 1] - 2 * psi[j] + psi[j + 1]);
      const double largest = psi[j] - 0.25 * (psi[j - 1] - psi[j + 1]) * shift;
      if (largest <= vortex.flow) continue;
      vortex = {largest, grid.face_position(1, static_cast<int>(j)) + shift / n};
    }
  }
  return vortex;
}

Flow<2> cavity(double bingham_number, int n) {
  CaseConfig config = testing::shipped_case("cavity/cavity");
  std::get<Papanastasiou>(config.species.front().law).yield_stress = bingham_number;
  config.grid.x.front().cells = config.grid.z.front().cells = n;
  return testing::steady_flow<2>(config);
}

void expect_vortex(const Flow<2>& flow, double height, double stream, double height_error, double stream_error) {
  const Vortex vortex = find_vortex(flow);
  EXPECT_NEAR(vortex.height, height, height_error);
  EXPECT_NEAR(vortex.flow, stream, stream_error * stream);
}

TEST(Cavity, NewtonianVortexOnACoarseGrid) { expect_vortex(cavity(0, 32), 0.7650, 0.1001, 0.005, 0.015); }

TEST(Cavity, SlowVorticesOfYieldStressLiquids) {
  expect_vortex(cavity(0, 64), 0.7650, 0.1001, 0.002, 0.005);
  expect_vortex(cavity(1, 64), 0.7956, 0.0868, 0.005, 0.015);
  expect_vortex(cavity(2, 64), 0.8155, 0.0781, 0.005, 0.015);
  expect_vortex(cavity(5, 64), 0.8478, 0.0634, 0.005, 0.015);
}

}  // namespace
}  // namespace quicksand
