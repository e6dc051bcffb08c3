// What follows from symmetry: results do not depend on how the same flow is described or on how many threads compute
// it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/cases.hpp"
#include "support/figures.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

/// A block of liquid in a tank, written out for each way to describe the same flow.
struct Block {
  std::string law = "{law: papanastasiou, viscosity: 0.01, yield_stress: 0.05, regularization: 50}";
  double end = 0.2;
};

std::string axis(double to, int cells) {
  return "{from: 0, to: " + std::to_string(to) + ", cells: " + std::to_string(cells) + "}";
}

/// What all descriptions share; tight tolerances, lest the solvers' errors hide differences.
CaseConfig block_case(const Block& block, const std::string& grid, const std::string& sides, const std::string& box) {
  return parse_case("title: a block in a tank\nunits: none\ngrid: {" + grid + "}\nboundaries: {" + sides +
                        ", z_min: no_slip, z_max: {open: 1.0}}\ngravity: 1.0\nambient_pressure: 1.0\n" +
                        "species: [{name: mud, density: 1.0, rheology: " + block.law + "}]\n" +
                        "initial: [{fill: mud, shape: {box: {" + box + "}}}]\n" +
                        "time: {end: " + std::to_string(block.end) + ", cfl: 0.3, max_step: 0.02}\n" +
                        "solver: {tolerance: 1.0e-12, viscous_tolerance: 1.0e-10}\n",
                    "block");
}

CaseConfig in_the_middle(const Block& block) {
  return block_case(block, "dimension: 2, geometry: planar, x: " + axis(1, 16) + ", z: " + axis(1, 16),
                    "x_min: no_slip, x_max: no_slip", "from: [0.25, 0, 0], to: [0.75, 0, 0.7]");
}

CaseConfig left_half(const Block& block) {
  return block_case(block, "dimension: 2, geometry: planar, x: " + axis(0.5, 8) + ", z: " + axis(1, 16),
                    "x_min: no_slip, x_max: symmetry", "from: [0.25, 0, 0], to: [0.5, 0, 0.7]");
}

CaseConfig at_the_wall(const Block& block) {
  return block_case(block, "dimension: 2, geometry: planar, x: " + axis(1, 16) + ", z: " + axis(1, 16),
                    "x_min: no_slip, x_max: no_slip", "from: [0, 0, 0], to: [0.375, 0, 0.7]");
}

CaseConfig one_cell_thick(const Block& block) {
  return block_case(block, "dimension: 3, x: " + axis(1, 16) + ", y: " + axis(0.0625, 1) + ", z: " + axis(1, 16),
                    "x_min: no_slip, x_max: no_slip, y_min: free_slip, y_max: free_slip",
                    "from: [0, 0, 0], to: [0.375, 0.0625, 0.7]");
}

/// A block in the corner of a box, with the horizontal axes swapped on request.
CaseConfig in_the_corner(const Block& block, bool swapped) {
  return block_case(block,
                    "dimension: 3, x: " + (swapped ? axis(0.75, 9) : axis(1, 12)) +
                        ", y: " + (swapped ? axis(1, 12) : axis(0.75, 9)) + ", z: " + axis(1, 12),
                    "x_min: no_slip, x_max: no_slip, y_min: no_slip, y_max: no_slip",
                    std::string("from: [0, 0, 0], to: [") + (swapped ? "0.25, 0.5" : "0.5, 0.25") + ", 0.6]");
}

/// Where a cell of one flow lies in another, and which component and sign the velocities have there.
template <int Dim>
struct Place {
  Index<Dim> index;
  int component[3] = {0, 1, 2};
  double sign[3] = {1, 1, 1};
};

/// Runs both cases with the steps of the first; largest difference of fractions and momenta.
template <int DimA, int DimB, class Map>
double difference(const CaseConfig& a_case, const CaseConfig& b_case, Map&& place_of) {
  Flow<DimA> a = build_flow<DimA>(a_case);
  Flow<DimB> b = build_flow<DimB>(b_case);
  testing::run(a_case, a, [&](const StepReport&) {
    b.advance(a.state().dt);
    return true;
  });
  EXPECT_GT(diagnose(a).max_speed, 0.05);
  return maximum<Cell>(a.domain().layout(), a.domain().grid.cells(), 0.0, [&](Cell c, const Index<DimA>& i) {
    const Place<DimB> place = place_of(i);
    const Cell there = b.domain().grid.cell(place.index);
    double largest = std::abs(a.total()[c] - b.total()[there]);
    for (int d = 0; d < DimA; ++d) {
      const double here = a.total()[c] * a.state().u[d][c];
      const double other = b.total()[there] * b.state().u[place.component[d]][there];
      largest = std::max(largest, std::abs(here - place.sign[d] * other));
    }
    return largest;
  });
}

TEST(Symmetry, ASymmetricFlowStaysSymmetric) {
  const CaseConfig config = in_the_middle({});
  const auto mirror = [](const Index<2>& i) { return Place<2>{{15 - i[0], i[1]}, {0, 1, 2}, {-1, 1, 1}}; };
  testing::expect_at_most({"symmetric flow", "difference of its halves", "0"}, difference<2, 2>(config, config, mirror),
                          1e-10);
}

TEST(Symmetry, HalfADomainGivesHalfTheFlow) {
  // Without stress to round-off. With it up to the quadrature, which has other points on a side than inside.
  const auto same = [](const Index<2>& i) { return Place<2>{i, {0, 1, 2}, {1, 1, 1}}; };
  const Block inviscid{.law = "{law: inviscid}"};
  testing::expect_at_most({"half a domain, inviscid", "difference to the whole", "0"},
                          difference<2, 2>(left_half(inviscid), in_the_middle(inviscid), same), 1e-9);
  testing::expect_at_most({"half a domain, slurry", "difference to the whole", "0"},
                          difference<2, 2>(left_half({}), in_the_middle({}), same), 1e-3);
}

TEST(Symmetry, OneCellThickSpaceIsThePlane) {
  // To round-off without stress; the stress has other quadrature points in space than in the plane.
  const auto slice = [](const Index<2>& i) { return Place<3>{{i[0], 0, i[1]}, {0, 2, 1}, {1, 1, 1}}; };
  const Block inviscid{.law = "{law: inviscid}"};
  testing::expect_at_most({"space of one cell's thickness, inviscid", "difference to the plane", "0"},
                          difference<2, 3>(at_the_wall(inviscid), one_cell_thick(inviscid), slice), 1e-9);
}

TEST(Symmetry, HorizontalAxesMayChangePlaces) {
  const auto swapped = [](const Index<3>& i) { return Place<3>{{i[1], i[0], i[2]}, {1, 0, 2}, {1, 1, 1}}; };
  testing::expect_at_most({"horizontal axes that change places", "difference", "0"},
                          difference<3, 3>(in_the_corner({}, false), in_the_corner({}, true), swapped), 1e-10);
}

/// A few steps of a slug on a grid that is large enough for threads.
template <int Dim>
Flow<Dim> slug_with_threads(const CaseConfig& config, int threads) {
  const ThreadScope scope(threads);
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
