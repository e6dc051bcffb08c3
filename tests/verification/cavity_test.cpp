// Lid-driven cavity without inertia: place and flow of the vortex against published values (Mitsoulis and Zisis 2001,
// Syrakos, Georgiou and Alexandrou 2013, and others who agree with them), yield stress Bn for unit speed, side and
// viscosity.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/stress.hpp"
#include "support/figures.hpp"
#include "support/viscometric.hpp"

namespace quicksand {
namespace {

const std::string published = "Syrakos, Georgiou and Alexandrou 2013 and others";

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

CaseConfig cavity_case(const Law& law, int n) {
  CaseConfig config = testing::shipped_case("cavity/cavity");
  config.species.front().law = law;
  config.grid.x.front().cells = config.grid.z.front().cells = n;
  return config;
}

Flow<2> cavity(const Law& law, int n) { return testing::steady_flow<2>(cavity_case(law, n)); }

void expect_vortex(const std::string& what, const Flow<2>& flow, double height, double stream, double height_error,
                   double stream_error) {
  const Vortex vortex = find_vortex(flow);
  testing::expect_absolute({"cavity, " + what, "height of the vortex", published}, vortex.height, height, height_error);
  testing::expect_relative({"cavity, " + what, "flow in the vortex", published}, vortex.flow, stream, stream_error);
}

TEST(Cavity, NewtonianVortexOnACoarseGrid) {
  expect_vortex("Bn = 0, 32 cells", cavity(Newtonian{1}, 32), 0.7650, 0.1001, 0.005, 0.015);
}

TEST(Cavity, VorticesOfYieldStressLiquids) {
  expect_vortex("Bn = 0, 64 cells", cavity(Newtonian{1}, 64), 0.7650, 0.1001, 0.002, 0.005);
  const double values[][3] = {{1, 0.7956, 0.0868}, {2, 0.8155, 0.0781}, {5, 0.8478, 0.0634}};
  for (const auto& [bingham_number, height, stream] : values) {
    SCOPED_TRACE(bingham_number);
    const std::string what = "Bn = " + std::to_string(static_cast<int>(bingham_number)) + ", alpha = 1000, 64 cells";
    expect_vortex(what, cavity(Papanastasiou{1, bingham_number, 1000}, 64), height, stream, 0.005, 0.015);
  }
}

TEST(Cavity, SlowRigidZonesOfBinghamsLaw) {
  // Unyielded on x = 0.5 at Bn = 5: 0 to 0.188 and 0.648 to 0.766. Their borders settle long after the vortex.
  const CaseConfig config = cavity_case(Bingham{1, 5}, 64);
  Flow<2> flow = build_flow<2>(config);
  testing::run(config, flow);
  expect_vortex("Bn = 5, Bingham's law, 64 cells", flow, 0.8478, 0.0634, 0.005, 0.015);
  const Grid<2>& grid = flow.domain().grid;
  const CellField unyielded = evaluate_stress(flow).unyielded;
  std::vector<double> ends{0};
  bool rigid = true;
  for (int j = 0; j < 64; ++j) {
    const bool now = unyielded[grid.cell({32, j})] > 0.5;
    if (now != rigid) ends.push_back(grid.face_position(1, j));
    rigid = now;
  }
  ASSERT_EQ(ends.size(), 4u);
  constexpr double cell = 1.0 / 64;
  const std::string rigid_zones = "cavity, Bn = 5, Bingham's law, 64 cells";
  // The liquid beside the lower zone hardly strains.
  testing::expect_absolute({rigid_zones, "top of the lower rigid zone", published}, ends[1], 0.188, 3 * cell);
  testing::expect_absolute({rigid_zones, "foot of the upper rigid zone", published}, ends[2], 0.648, 2 * cell);
  testing::expect_absolute({rigid_zones, "top of the upper rigid zone", published}, ends[3], 0.766, 2 * cell);
}

}  // namespace
}  // namespace quicksand
