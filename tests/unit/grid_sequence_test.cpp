// Grid sequences: refined axes, stages in turn, and blocks of fine cells that follow a bubble.
#include <gtest/gtest.h>

#include <cmath>

#include "app/adapted_axis.hpp"
#include "app/grid_sequence.hpp"
#include "physics/energy.hpp"
#include "physics/remap.hpp"
#include "support/cases.hpp"
#include "support/grids.hpp"
#include "unit/config_test_case.hpp"

namespace quicksand {
namespace {

double width(const std::vector<double>& faces, std::size_t i) { return faces[i + 1] - faces[i]; }

TEST(AdaptedAxis, HasTheGivenWidthInsideAndGrowsSteadilyOutside) {
  const std::vector<double> base = testing::uniform_axis(10, -1, 4);
  const RefinedInterval fine{0.3, 0.8, 0.01, 0.15};
  const std::vector<double> faces = adapted_faces(base, fine);
  EXPECT_EQ(faces.front(), -1);
  EXPECT_EQ(faces.back(), 4);
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    const double w = width(faces, i);
    EXPECT_LE(w, 0.5 * (1 + 1e-9));
    const double distance = std::max({fine.low - faces[i + 1], faces[i] - fine.high, 0.0});
    EXPECT_LE(w, 1.02 * (fine.width + fine.growth * (distance + w))) << "cell " << i;
    if (faces[i] >= fine.low && faces[i + 1] <= fine.high) {
      EXPECT_NEAR(w, 0.01, 2e-4);
    }
    if (i > 0) {
      const double ratio = w / width(faces, i - 1);
      EXPECT_GT(ratio, 0.8);
      EXPECT_LT(ratio, 1.25);
    }
  }
  EXPECT_LT(faces.size(), 120u);
}

TEST(AdaptedAxis, LeavesFinerCellsAlone) {
  const std::vector<double> base = testing::uniform_axis(40, 0, 1);
  const std::vector<double> faces = adapted_faces(base, {0.4, 0.6, 0.1, 0.15});
  ASSERT_EQ(faces.size(), base.size());
  for (std::size_t i = 0; i < base.size(); ++i) EXPECT_NEAR(faces[i], base[i], 1e-12);
}

const std::string two_stages = R"(stages:
  - {until: 1, grid: {x: {from: 0, to: 0.5, cells: 32}, z: {from: 0, to: 1.5, cells: 96}}}
  - until: 2
    grid:
      x: {from: 0, to: 0.5, cells: 20}
      z: [{from: 0, to: 1, cells: 40}, {to: 1.5, cells: 10, stretch: smooth}]
)";

TEST(GridSequence, StagesFollowEachOther) {
  const CaseConfig config = parse_case(valid_case + two_stages, "case.yaml");
  GridSequence<2> grids(config);
  Flow<2> flow = build_flow<2>(config, grids.first());
  EXPECT_EQ(flow.domain().grid.global_cells(), (Index<2>{{32, 96}}));
  flow.state().time = 0.999;
  EXPECT_FALSE(grids.next(flow));
  flow.state().time = 1;
  const auto second = grids.next(flow);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->grid.global_cells(), (Index<2>{{20, 50}}));
  EXPECT_EQ(second->sides.at(0, 0).kind, SideKind::axis);
  flow.state().time = 2.5;
  const auto last = grids.next(flow);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->grid.global_cells(), (Index<2>{{16, 48}}));
  EXPECT_FALSE(grids.next(flow));
  EXPECT_EQ(grids.number(), 3);
}

TEST(GridSequence, StagesReadBackFromYaml) {
  const CaseConfig config = parse_case(valid_case + two_stages + "regrid: {bubble_cells: 8}\n", "case.yaml");
  const CaseConfig again = parse_case(to_yaml(config), "again.yaml");
  ASSERT_EQ(again.stages.size(), 2u);
  EXPECT_EQ(again.stages[1].until, 2);
  EXPECT_EQ(make_faces(again.stages[1].grid.z), make_faces(config.stages[1].grid.z));
  ASSERT_TRUE(again.regrid);
  EXPECT_EQ(again.regrid->bubble_cells, 8);
}

TEST(GridSequence, WrongStagesAreRefused) {
  const auto error = [](const std::string& from, const std::string& to) {
    return error_of(valid_case + with(from, to, two_stages));
  };
  EXPECT_NE(error("until: 2", "until: 0.5").find("stages[1].until: stages must follow each other"), std::string::npos);
  EXPECT_NE(error("until: 2", "until: 4").find("stages[1].until: must be before the end of the run, 4"),
            std::string::npos);
  EXPECT_NE(error("to: 0.5, cells: 32", "to: 0.6, cells: 32").find("stages[0].grid.x: must go from 0 to 0.5"),
            std::string::npos);
  EXPECT_NE(error("x: {from: 0, to: 0.5, cells: 20}\n", "y: {from: 0, to: 1, cells: 2}\n").find("stages[1].grid.x"),
            std::string::npos);
  EXPECT_NE(error("cells: 10, stretch", "cells: 2, stretch").find("use more cells"), std::string::npos);
  EXPECT_NE(error_of(valid_case + "regrid: {bubble_cells: 3}\n").find("regrid.bubble_cells"), std::string::npos);
}

TEST(GridSequence, FollowsABubbleFromItsFirstSizeToTheGivenGrid) {
  // A disc of gas that starts at a fifth of a cell and grows sixteenfold.
  CaseConfig config = testing::shipped_case("bubbles/free_disc", {"regrid.bubble_cells=8"});
  config.grid.x.front() = config.grid.z.front() = {0, 30, 60, Stretch::uniform};
  std::get<SphereShape>(config.initial.front().shape).radius = 24;
  config.bubbles.front().pressure = 100;
  config.bubbles.front().adiabatic_exponent = 1.3;
  GridSequence<2> grids(config);
  Flow<2> flow = build_flow<2>(config, grids.first());
  EXPECT_NEAR(flow.domain().grid.smallest_width(), 1.0 / 8, 0.01);
  const double amount = flow.state().gas.bubbles.front().amount;
  const double liquid = species_volume(flow.domain().grid, flow.state().phi[0]);
  TimeControl control(config.time, config.output.fields);
  double width = flow.domain().grid.smallest_width();
  while (flow.state().time < 8) {
    if (auto domain = grids.next(flow)) {
      RemapReport report;
      const double energy = kinetic_energy(flow.domain().grid, flow.density(), flow.state().u);
      flow = remap(flow, std::move(*domain), report);
      EXPECT_GT(flow.domain().grid.smallest_width(), 2 * width);
      width = flow.domain().grid.smallest_width();
      EXPECT_LE(kinetic_energy(flow.domain().grid, flow.density(), flow.state().u), energy * (1 + 1e-12));
    }
    flow.advance(control.next_step(flow.state().time, flow.state().dt, stable_step(flow, 0.5)));
    ASSERT_EQ(flow.state().gas.bubbles.size(), 1u);
  }
  EXPECT_EQ(grids.number(), 3);
  EXPECT_NEAR(flow.domain().grid.smallest_width(), 0.5, 1e-12);
  EXPECT_EQ(flow.state().gas.bubbles.front().amount, amount);
  EXPECT_NEAR(species_volume(flow.domain().grid, flow.state().phi[0]), liquid, 1e-10 * liquid);
  const double quarter = std::acos(-1.0) / 4;
  const double radius = std::sqrt(flow.state().gas.bubbles.front().volume / quarter);
  RecordProperty("radius", std::to_string(radius));
  EXPECT_GT(radius, 5);
}

}  // namespace
}  // namespace quicksand
