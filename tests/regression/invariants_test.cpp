// What must hold in every step of every shipped case that no pressure drives: volumes, room in cells, energy of
// redistribution and projection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

struct ShippedCase {
  const char* name;
  double end;   ///< of the short run
  double full;  ///< of the long one
};

std::ostream& operator<<(std::ostream& out, const ShippedCase& c) { return out << c.name; }

/// Runs a case to `end` and checks every step.
template <int Dim>
void expect_invariants(const std::string& name, CaseConfig config, double end) {
  config.time.end = end;
  Flow<Dim> flow = build_flow<Dim>(config);
  const Grid<Dim>& grid = flow.domain().grid;
  const auto volumes = [&] {
    std::vector<double> v;
    for (std::size_t i = 0; i < flow.state().phi.size(); ++i) {
      v.push_back(species_volume(grid, flow.state().phi[i]) + flow.escaped()[i]);
    }
    return v;
  };
  const std::vector<double> start = volumes();
  double whole = 0;
  for (const double v : start) whole += v;
  const double circle = grid.axisymmetric() ? 2 * std::numbers::pi : 1.0;
  double volume_error = 0;
  double redistribution_rise = 0;
  double projection_rise = 0;
  testing::run(config, flow, [&](const StepReport& report) {
    const std::vector<double> now = volumes();
    for (std::size_t i = 0; i < now.size(); ++i) {
      volume_error = std::max(volume_error, std::abs(now[i] - start[i]) / whole);
      EXPECT_NEAR(now[i], start[i], 1e-10 * whole);
    }
    const double fullest = maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) { return flow.total()[c]; });
    EXPECT_LE(fullest, 1 + 10 * config.solver.tolerance);
    for (const CellField& phi : flow.state().phi) {
      EXPECT_LE(maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) { return -phi[c]; }), 1e-9);
    }
    const Diagnostics d = diagnose(flow);
    const double energy = (d.kinetic_energy + std::abs(d.potential_energy)) / circle;
    double gas_energy = 0;
    for (const Bubble& b : flow.state().gas.bubbles) gas_energy += b.pressure * b.volume / (b.exponent - 1);
    if (energy > 0) {
      redistribution_rise = std::max(redistribution_rise, report.redistribution_energy_change / energy);
      projection_rise =
          std::max(projection_rise, (report.projection_energy_change - report.gas_work) / (energy + gas_energy));
    }
    EXPECT_LE(report.redistribution_energy_change, 1e-12 * energy);
    EXPECT_LE(report.projection_energy_change - report.gas_work, 1e-12 * (energy + gas_energy));
    return !::testing::Test::HasFailure();
  });
  testing::expect_at_most({name, "largest change of a species' volume over the whole", "kept"}, volume_error, 1e-10);
  testing::expect_at_most({name, "largest rise of energy in redistribution, relative", "none"}, redistribution_rise,
                          1e-12);
  testing::expect_at_most({name, "largest rise of energy in projection, relative", "none"}, projection_rise, 1e-12);
}

class Invariants : public ::testing::TestWithParam<ShippedCase> {
 protected:
  /// \param by_cfl  whether slugs take steps by CFL number, to get far in little time
  static void expect(double end, bool by_cfl) {
    const std::string name = GetParam().name;
    CaseConfig config = testing::shipped_case(name);
    if (by_cfl && config.time.step && name != "slabs/colliding") config = testing::with_cfl(config);
    if (config.grid.dimension == 2) expect_invariants<2>(name, config, end);
    if (config.grid.dimension == 3) expect_invariants<3>(name, config, end);
  }
};

TEST_P(Invariants, HoldInEveryStep) { expect(GetParam().end, true); }

using InvariantsSlow = Invariants;
TEST_P(InvariantsSlow, HoldInEveryStepOfTheWholeRun) { expect(GetParam().full, false); }

const ShippedCase cases[] = {
    {"slug/case_a", 1.2, 6},
    {"slug/case_b", 1.2, 6},
    {"slug/case_c", 0.8, 4},
    {"slug/case_d", 0.8, 4},
    {"slug/case_e", 0.8, 4},
    {"slug/case_e_bingham", 0.4, 4},
    {"slug/case_f", 0.5, 4},
    {"slug/case_f_bingham", 0.3, 2},
    {"slug/case_g", 0.5, 4},
    {"slug/case_b_3d", 0.1, 0.8},
    {"slug/case_e_3d", 0.06, 1},
    {"rest/sand_under_water", 0.5, 5},
    {"dam_break/martin_moyce", 0.8, 2.5},
    {"sloshing/planar", 1, 11.1},
    {"sloshing/axisymmetric", 1, 6.8},
    {"sloshing/two_layer", 1, 12.8},
    {"slabs/colliding", 1, 1},
    {"slope/mud", 5, 120},
    {"channel/couette", 1, 10},
    {"cavity/cavity", 5e-4, 3e-3},
    {"bubbles/free_disc", 1, 12},
    {"bubbles/free_ball", 0.5, 4.7},
    {"bench/overturning_3d", 0.06, 2},
    {"bench/tank", 0.1, 2},
};

std::string name_of(const ::testing::TestParamInfo<ShippedCase>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Cases, Invariants, ::testing::ValuesIn(cases), name_of);
INSTANTIATE_TEST_SUITE_P(Cases, InvariantsSlow, ::testing::ValuesIn(cases), name_of);

}  // namespace
}  // namespace quicksand
