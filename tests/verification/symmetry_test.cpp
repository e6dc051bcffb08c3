// What follows from symmetry: results do not depend on how the same flow is described or on how many threads compute
// it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/cases.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

/// A yielding block beside a pool, in a closed tank; `cells` in x and z, symmetric about x = 1/2 if `middle`.
std::string planar_text(int x_cells, double x_end, const std::string& x_max, const std::string& block) {
  return "title: a block in a tank\nunits: none\n"
         "grid: {dimension: 2, geometry: planar, x: {from: 0, to: " +
         std::to_string(x_end) + ", cells: " + std::to_string(x_cells) +
         "}, z: {from: 0, to: 1, cells: 16}}\n"
         "boundaries: {x_min: no_slip, x_max: " +
         x_max +
         ", z_min: no_slip, z_max: {open: 1.0}}\n"
         "gravity: 1.0\nambient_pressure: 1.0\n"
         "species: [{name: mud, density: 1.0, rheology: {law: papanastasiou, viscosity: 0.01, yield_stress: 0.1, "
         "regularization: 50}}]\n"
         "initial: [{fill: mud, shape: {box: {from: [" +
         block +
         "}}}]\n"
         "time: {end: 0.6, cfl: 0.3, max_step: 0.02}\n"
         "solver: {tolerance: 1.0e-12, viscous_tolerance: 1.0e-10}\n";
}

TEST(Symmetry, ASymmetricFlowStaysSymmetric) {
  const CaseConfig config = parse_case(planar_text(16, 1, "no_slip", "0.25, 0, 0], to: [0.75, 0, 0.7]"), "block");
  Flow<2> flow = build_flow<2>(config);
  const Grid<2>& grid = flow.domain().grid;
  testing::run(config, flow);
  EXPECT_GT(diagnose(flow).max_speed, 0.01);
  double difference = 0;
  for_each_indexed<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<2>& i) {
    const Cell mirror = grid.cell({15 - i[0], i[1]});
    difference = std::max(difference, std::abs(flow.total()[c] - flow.total()[mirror]));
    difference = std::max(difference, std::abs(flow.state().u[0][c] + flow.state().u[0][mirror]));
    difference = std::max(difference, std::abs(flow.state().u[1][c] - flow.state().u[1][mirror]));
  });
  EXPECT_LE(difference, 1e-8);
}

TEST(Symmetry, HalfADomainGivesHalfTheFlow) {
  const CaseConfig whole_case = parse_case(planar_text(16, 1, "no_slip", "0.25, 0, 0], to: [0.75, 0, 0.7]"), "block");
  const CaseConfig half_case = parse_case(planar_text(8, 0.5, "symmetry", "0.25, 0, 0], to: [0.5, 0, 0.7]"), "half");
  Flow<2> whole = build_flow<2>(whole_case);
  Flow<2> half = build_flow<2>(half_case);
  testing::run(whole_case, whole);
  testing::run(half_case, half);
  EXPECT_EQ(whole.state().step, half.state().step);
  double difference = 0;
  const Grid<2>& grid = half.domain().grid;
  for_each_indexed<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<2>& i) {
    const Cell there = whole.domain().grid.cell(i);
    difference = std::max(difference, std::abs(half.total()[c] - whole.total()[there]));
    for (int d = 0; d < 2; ++d) {
      difference = std::max(difference, std::abs(half.state().u[d][c] - whole.state().u[d][there]));
    }
  });
  EXPECT_LE(difference, 1e-7);
}

/// The planar block in three dimensions, one cell thick along x or y.
std::string slice_text(bool along_x) {
  const std::string wide = "{from: 0, to: 1, cells: 16}";
  const std::string thin = "{from: 0, to: 0.0625, cells: 1}";
  const std::string wall = "no_slip, ";
  const std::string free = "free_slip, ";
  return "title: a slice\nunits: none\n"
         "grid: {dimension: 3, x: " +
         (along_x ? wide : thin) + ", y: " + (along_x ? thin : wide) +
         ", z: {from: 0, to: 1, cells: 16}}\n"
         "boundaries: {x_min: " +
         (along_x ? wall : free) + "x_max: " + (along_x ? wall : free) + "y_min: " + (along_x ? free : wall) +
         "y_max: " + (along_x ? free : wall) +
         "z_min: no_slip, z_max: {open: 1.0}}\n"
         "gravity: 1.0\nambient_pressure: 1.0\n"
         "species: [{name: mud, density: 1.0, rheology: {law: papanastasiou, viscosity: 0.01, yield_stress: 0.1, "
         "regularization: 50}}]\n"
         "initial: [{fill: mud, shape: {box: {from: [0, 0, 0], to: [" +
         (along_x ? "0.375, 0.0625" : "0.0625, 0.375") +
         ", 0.7]}}}]\n"
         "time: {end: 0.6, cfl: 0.3, max_step: 0.02}\n"
         "solver: {tolerance: 1.0e-12, viscous_tolerance: 1.0e-10}\n";
}

TEST(Symmetry, OneCellThickSpaceIsThePlane) {
  const CaseConfig plane_case = parse_case(planar_text(16, 1, "no_slip", "0, 0, 0], to: [0.375, 0, 0.7]"), "plane");
  const CaseConfig slice_case = parse_case(slice_text(true), "slice");
  Flow<2> plane = build_flow<2>(plane_case);
  Flow<3> slice = build_flow<3>(slice_case);
  testing::run(plane_case, plane);
  testing::run(slice_case, slice);
  EXPECT_EQ(plane.state().step, slice.state().step);
  EXPECT_GT(diagnose(plane).max_speed, 0.01);
  double difference = 0;
  for_each_indexed<Cell>(plane.domain().layout(), plane.domain().grid.cells(), [&](Cell c, const Index<2>& i) {
    const Cell there = slice.domain().grid.cell({i[0], 0, i[1]});
    difference = std::max(difference, std::abs(plane.total()[c] - slice.total()[there]));
    difference = std::max(difference, std::abs(plane.state().u[0][c] - slice.state().u[0][there]));
    difference = std::max(difference, std::abs(plane.state().u[1][c] - slice.state().u[2][there]));
    difference = std::max(difference, std::abs(slice.state().u[1][there]));
  });
  EXPECT_LE(difference, 1e-7);
}

/// A block off the middle of a box, with the horizontal axes swapped on request.
CaseConfig skew_block(bool swapped) {
  const std::string a = "{from: 0, to: 1, cells: 12}";
  const std::string b = "{from: 0, to: 0.75, cells: 9}";
  return parse_case(
      "title: a block in a box\nunits: none\n"
      "grid: {dimension: 3, x: " +
          (swapped ? b : a) + ", y: " + (swapped ? a : b) +
          ", z: {from: 0, to: 1, cells: 12}}\n"
          "boundaries: {x_min: no_slip, x_max: no_slip, y_min: no_slip, y_max: no_slip, z_min: no_slip, "
          "z_max: {open: 1.0}}\n"
          "gravity: 1.0\nambient_pressure: 1.0\n"
          "species: [{name: mud, density: 1.0, rheology: {law: papanastasiou, viscosity: 0.01, yield_stress: 0.1, "
          "regularization: 50}}]\n"
          "initial: [{fill: mud, shape: {box: {from: [0, 0, 0], to: [" +
          (swapped ? "0.25, 0.5" : "0.5, 0.25") +
          ", 0.6]}}}]\n"
          "time: {end: 0.3, cfl: 0.3, max_step: 0.02}\n"
          "solver: {tolerance: 1.0e-12, viscous_tolerance: 1.0e-10}\n",
      "skew block");
}

TEST(Symmetry, HorizontalAxesMayChangePlaces) {
  const CaseConfig one_case = skew_block(false);
  const CaseConfig other_case = skew_block(true);
  Flow<3> one = build_flow<3>(one_case);
  Flow<3> other = build_flow<3>(other_case);
  testing::run(one_case, one);
  testing::run(other_case, other);
  EXPECT_EQ(one.state().step, other.state().step);
  EXPECT_GT(diagnose(one).max_speed, 0.01);
  double difference = 0;
  for_each_indexed<Cell>(one.domain().layout(), one.domain().grid.cells(), [&](Cell c, const Index<3>& i) {
    const Cell there = other.domain().grid.cell({i[1], i[0], i[2]});
    difference = std::max(difference, std::abs(one.total()[c] - other.total()[there]));
    for (int d = 0; d < 3; ++d) {
      const int swapped = d == 2 ? 2 : 1 - d;
      difference = std::max(difference, std::abs(one.state().u[d][c] - other.state().u[swapped][there]));
    }
  });
  EXPECT_LE(difference, 1e-7);
}

/// A few steps of a slug on a grid that is large enough for threads.
template <int Dim>
Flow<Dim> slug_with_threads(const CaseConfig& config, int threads) {
  const testing::Threads scope(threads);
  Flow<Dim> flow = build_flow<Dim>(config);
  for (int k = 0; k < 4; ++k) flow.advance(2e-3);
  return flow;
}

template <int Dim>
void expect_same_bits(const CaseConfig& config) {
  const Flow<Dim> one = slug_with_threads<Dim>(config, 1);
  for (const int threads : {2, 4}) {
    const Flow<Dim> many = slug_with_threads<Dim>(config, threads);
    const Grid<Dim>& grid = one.domain().grid;
    EXPECT_EQ(testing::largest_difference(grid, one.total(), many.total()), 0);
    for (int d = 0; d < Dim; ++d) {
      EXPECT_EQ(testing::largest_difference(grid, one.state().u[d], many.state().u[d]), 0);
    }
  }
}

TEST(Symmetry, ThreadsGiveTheSameBitsInATank) {
  expect_same_bits<2>(testing::refined(testing::shipped_case("slug/case_e"), 4));
}

TEST(Symmetry, ThreadsGiveTheSameBitsInSpace) { expect_same_bits<3>(testing::shipped_case("slug/case_e_3d")); }

}  // namespace
}  // namespace quicksand
