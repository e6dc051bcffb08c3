// The tables of the crater in a bed.
#include <algorithm>

#include "app/build_flow.hpp"
#include "app/crater_writer.hpp"
#include "config_test_case.hpp"
#include "unit/output_test_folder.hpp"

namespace quicksand {
namespace {

using CraterWriterTest = FolderTest;

/// A bed of height 0.4 with a trench along the axis down to 0.1, on cells of 1/16 or as many as `nx` says.
CaseConfig trench(const std::string& crater, int nx = 8) {
  return parse_case(with("shape: {cylinder: {center: [0, 0, 0], radius: 0.25, height: 1.0}}",
                         "shape: {box: {from: [0.1, 0], to: [0.5, 0.4]}}\n  - fill: sand\n"
                         "    shape: {box: {from: [0, 0], to: [0.1, 0.1]}}",
                         with("cells: 16", "cells: " + std::to_string(nx), valid_case) + "  crater: " + crater + "\n"),
                    "case.yaml");
}

Flow<2> at(const CaseConfig& config, long step, double time) {
  Flow<2> flow = build_flow<2>(config);
  flow.state().step = step;
  flow.state().time = time;
  return flow;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST_F(CraterWriterTest, WritesWhenDueOnAnyGrid) {
  const CaseConfig config = trench("{species: sand, every: 0.1}", 10);
  CraterWriter<2> writer(config, folder_);
  writer.append(at(config, 0, 0));
  writer.append_when_due(at(config, 1, 0));  // as a run does after its first output
  writer.append_when_due(at(config, 7, 0.09));
  EXPECT_EQ(lines(content(path("crater.csv"))), 2U);
  writer.append_when_due(at(config, 8, 0.1 * (1 - 1e-12)));
  writer.append_when_due(at(config, 9, 0.15));
  writer.append_when_due(at(trench("{species: sand}", 20), 10, 0.41));  // several intervals later, on finer cells
  writer.append(at(config, 10, 0.41));
  const std::string table = content(path("crater.csv"));
  EXPECT_EQ(lines(table), 4U);
  EXPECT_EQ(table.rfind("step,time,level,depth,deepest_x,width,volume,open_depth,", 0), 0U) << table;
  const std::string profiles = content(path("crater_profiles.csv"));
  EXPECT_EQ(lines(profiles), 1U + 10 + 10 + 20);
  EXPECT_EQ(profiles.rfind("step,time,x,surface,top\n0,0,0.025,0.1,0.1\n", 0), 0U) << profiles;
}

TEST_F(CraterWriterTest, GoesOnAfterAnInterruption) {
  const CaseConfig config = trench("{species: sand, every: 0.1}");
  {
    CraterWriter<2> writer(config, folder_);
    writer.append(at(config, 0, 0));
    writer.append_when_due(at(config, 5, 0.1));
  }
  const std::string before = content(path("crater.csv"));
  {
    CraterWriter<2> writer(config, folder_, 5);
    writer.append_when_due(at(config, 6, 0.15));  // not due
    writer.append(at(config, 5, 0.1));            // there already
    EXPECT_EQ(content(path("crater.csv")), before);
    CaseConfig lower = config;
    std::get<BoxShape>(lower.initial.front().shape).to[2] = 0.3;
    writer.append_when_due(at(lower, 7, 0.2));
    EXPECT_NE(content(path("crater.csv")).find("\n7,0.2,0.4,"), std::string::npos);  // the level of the start
  }
  CraterWriter<2> again(config, folder_, 5);
  EXPECT_EQ(content(path("crater.csv")), before);
  EXPECT_EQ(lines(content(path("crater_profiles.csv"))), 1U + 8 + 8);
}

TEST_F(CraterWriterTest, TakesTheLevelOfTheCase) {
  const CaseConfig config = trench("{species: sand, level: 0.5}");
  CraterWriter<2> writer(config, folder_);
  writer.append_when_due(at(config, 5, 1));  // without an interval only when told
  EXPECT_EQ(lines(content(path("crater.csv"))), 1U);
  writer.append(at(config, 6, 1));
  EXPECT_NE(content(path("crater.csv")).find("\n6,1,0.5,0.4,"), std::string::npos);
}

TEST_F(CraterWriterTest, BedOfSeveralSpecies) {
  CaseConfig config = trench("{species: [sand, water]}");
  config.initial.back().fill = "water";  // on the floor of the trench
  CraterWriter<2> writer(config, folder_);
  writer.append(at(config, 0, 0));
  EXPECT_NE(content(path("crater_profiles.csv")).find("\n0,0,0.03125,0.1,0.1\n"), std::string::npos)
      << content(path("crater_profiles.csv"));
}

}  // namespace
}  // namespace quicksand
