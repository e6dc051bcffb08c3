// Explosions from charge to crater: periods, jets, venting, and the report's box.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/grid_sequence.hpp"
#include "app/initial_bubbles.hpp"
#include "physics/bubble_measures.hpp"
#include "physics/remap.hpp"
#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

/// Runs a case through its grids until after(flow, report) returns false. \returns the flow at the end
template <int Dim, class After>
Flow<Dim> run_sequence(const CaseConfig& config, After&& after) {
  GridSequence<Dim> grids(config);
  Flow<Dim> flow = build_flow<Dim>(config, grids.first());
  TimeControl control(config.time, {});
  while (!control.finished(flow.state().time)) {
    if (auto domain = grids.next(flow)) {
      RemapReport report;
      flow = remap(flow, std::move(*domain), report);
      EXPECT_LE(report.kinetic_energy, report.kinetic_energy_before * (1 + 1e-12));
    }
    const double stable = stable_step(flow, control.cfl());
    const StepReport report = flow.advance(control.next_step(flow.state().time, flow.state().dt, stable));
    if (!after(flow, report)) break;
  }
  return flow;
}

/// The bubble that has been there from the start; null once it is gone.
template <int Dim>
const Bubble* first_bubble(const Flow<Dim>& flow) {
  for (const Bubble& b : flow.state().gas.bubbles) {
    if (b.id == open_air + 1) return &b;
  }
  return nullptr;
}

/// Largest and following smallest volume of a bubble.
struct Extremes {
  double largest = 0;
  double time_of_largest = 0;
  double smallest = 0;
  double time_of_smallest = 0;

  void note(double volume, double time) {
    if (volume > largest) {
      largest = smallest = volume;
      time_of_largest = time_of_smallest = time;
    } else if (volume < smallest) {
      smallest = volume;
      time_of_smallest = time;
    }
  }
};

TEST(Explosion, DeepOneHasTheFreeFieldPeriod) {
  const CaseConfig config = testing::shipped_case("explosions/deep");
  const PlacedCharge charge = place_charge(config, config.charges.front());
  Extremes extremes;
  run_sequence<2>(config, [&](const Flow<2>& flow, const StepReport&) {
    const Bubble* bubble = first_bubble(flow);
    if (bubble == nullptr) return false;
    extremes.note(full_circle(flow.domain().grid) * bubble->volume, flow.state().time);
    return bubble->volume < 3 * extremes.smallest || flow.state().time < extremes.time_of_smallest + 0.01;
  });
  const double radius = std::cbrt(extremes.largest * 3 / (4 * std::acos(-1.0)));
  const std::string pound = "1 lb of TNT at 50 ft";
  const double period =
      free_field_period(charge.bubble, config.charges.front().adiabatic_exponent, charge.p_inf, charge.density);
  testing::expect_relative({pound, "largest radius (m)", "free field, (57)"}, radius, charge.bubble.maximum_radius,
                           0.03);
  testing::expect_relative({pound, "first period (s)", "free field, Rayleigh"}, extremes.time_of_smallest, period,
                           0.05);
  testing::expect_relative({pound, "largest radius (m)", "12.6 (W/Z)^(1/3) ft, Cole"}, radius,
                           12.6 * std::cbrt(1 / 83.0) * 0.3048, 0.05);
  testing::expect_relative({pound, "first period (s)", "4.36 W^(1/3) / Z^(5/6) s, Cole"}, extremes.time_of_smallest,
                           4.36 / std::pow(83, 5.0 / 6), 0.05);
}

TEST(Explosion, BubbleNearAWallJetsToIt) {
  const CaseConfig config = testing::shipped_case("explosions/wall");
  double fastest_down = 0;
  double highest = 0;
  double lowest = 10;
  run_sequence<2>(config, [&](const Flow<2>& flow, const StepReport&) {
    const auto bubbles = measure_bubbles(flow);
    if (bubbles.empty()) return false;
    highest = std::max(highest, bubbles.front().centroid[1]);
    lowest = std::min(lowest, bubbles.front().centroid[1]);
    const Grid<2>& grid = flow.domain().grid;
    for (int k = 0; k < grid.owned_cells()[1]; ++k) {
      const Cell c = grid.cell({{0, k}});
      if (flow.total()[c] > 0.9) fastest_down = std::min(fastest_down, flow.state().u[1][c]);
    }
    return true;
  });
  EXPECT_LT(lowest, highest - 1) << "the bubble moves to the wall";
  // Jets of bubbles that collapse at about one radius from a wall reach some ten times sqrt(P / rho).
  EXPECT_LT(fastest_down, -4);
  EXPECT_GT(fastest_down, -30);
}

TEST(Explosion, SlowShallowOneVentsOnceAndThenHasTheAmbientPressure) {
  CaseConfig config = testing::shipped_case("explosions/shallow");
  config.time.end = 0.06;
  int vented = 0;
  const Flow<2> flow = run_sequence<2>(config, [&](const Flow<2>&, const StepReport& report) {
    for (const GasEvent& event : report.gas) {
      if (event.kind == GasEventKind::vented && event.bubble == open_air + 1) ++vented;
    }
    return true;
  });
  EXPECT_GE(vented, 1);
  EXPECT_EQ(first_bubble(flow), nullptr);
}

/// What the report shows of the box: the bubble's largest volume, and the jet.
TEST(Explosion, SlowUmdBoxHasTheBubbleAndTheJetOfTheExperiment) {
  CaseConfig config = testing::shipped_case("umd_box/channel_0590");
  config.time.end = 18e-3;
  const double inch = 0.0254;
  Extremes extremes;
  double jet_begins = 0;
  const Flow<2> flow = run_sequence<2>(config, [&](const Flow<2>& now, const StepReport&) {
    const Bubble* bubble = first_bubble(now);
    if (bubble == nullptr) return false;
    const double time = now.state().time;
    if (time < 12e-3) extremes.note(bubble->volume, time);
    const Grid<2>& grid = now.domain().grid;
    double down = 0;
    for (int k = 0; k < grid.owned_cells()[1]; ++k) {
      const Cell c = grid.cell({{0, k}});
      const double z = grid.centre_position(1, k);
      if (z > -4 * inch && z < 2 * inch && now.total()[c] > 0.9) down = std::min(down, now.state().u[1][c]);
    }
    if (jet_begins == 0 && time > extremes.time_of_largest && down < -10) jet_begins = time;
    return true;
  });
  const std::string box = "the report's box, 0.59 P_A";
  testing::expect_absolute({box, "bubble largest at (ms)", "experiment, Fig. 13: between frames"},
                           1e3 * extremes.time_of_largest, 8.5, 1);
  EXPECT_GT(jet_begins, extremes.time_of_largest);
  testing::expect_at_most({box, "jet begins at (ms)", "experiment, Fig. 13: seen from 12 ms on"}, 1e3 * jet_begins, 14);
}

}  // namespace
}  // namespace quicksand
