// Regions of gas: labels and volumes, and what becomes of bubbles that split, merge, vent, close and vanish.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/threads.hpp"
#include "physics/gas_regions.hpp"
#include "physics/mixture.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

using testing::make_domain;

constexpr double eps = 0.95;

/// Liquid fractions drawn in text, the uppermost row first: '#' full, ' ' empty, digits tenths.
CellField draw(const Grid<2>& grid, const std::vector<std::string>& picture) {
  CellField total(grid.layout());
  const int rows = static_cast<int>(picture.size());
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<2>& i) {
    const char sign = picture[static_cast<std::size_t>(rows - 1 - i[1])][static_cast<std::size_t>(i[0])];
    total[c] = sign == '#' ? 1 : sign == ' ' ? 0 : (sign - '0') / 10.0;
  });
  return total;
}

/// A closed or open-topped box with gas that is moved from picture to picture by hand.
struct Scene {
  Domain<2> domain;
  GasParameters parameters{.ambient_pressure = 1, .liquid_threshold = eps, .trapped = {}};
  GasLabels labels;
  GasState gas, next;
  CellField total;

  explicit Scene(const std::vector<std::string>& picture, bool open_top = false)
      : domain(box(picture, open_top)), labels(domain.layout()), gas(domain.layout()), next(domain.layout()) {
    total = draw(domain.grid, picture);
  }
  static Domain<2> box(const std::vector<std::string>& picture, bool open_top) {
    const int nx = static_cast<int>(picture.front().size());
    const int nz = static_cast<int>(picture.size());
    Grid<2> grid({testing::uniform_axis(nx, 0, nx), testing::uniform_axis(nz, 0, nz)}, Geometry::planar);
    Sides<2> sides = testing::all_sides(grid, SideKind::free_slip);
    if (open_top) sides.at(1, 1).kind = SideKind::open;
    return {std::move(grid), sides};
  }
  /// A bubble in all cells of the columns from ... to that are less than half full.
  int add_bubble(int from, int to, double pressure, double exponent = 1.4) {
    const int id = ++gas.last_id;
    gas.bubbles.push_back({.id = id, .exponent = exponent, .pressure = pressure});
    for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<2>& i) {
      if (i[0] >= from && i[0] < to && total[c] < 0.5) gas.region[c] = id;
    });
    return id;
  }
  void start() { start_gas(domain, parameters, total, labels, gas); }
  std::vector<GasEvent> move_to(const std::vector<std::string>& picture) {
    const CellField later = draw(domain.grid, picture);
    const auto events = advance_gas(domain, parameters, gas, total, later, 0.1, labels, next);
    std::swap(gas, next);
    total = later;
    return events;
  }
  const Bubble& bubble(int id) const {
    for (const Bubble& b : gas.bubbles) {
      if (b.id == id) return b;
    }
    throw std::out_of_range("no bubble " + std::to_string(id));
  }
  double amount() const {
    double sum = 0;
    for (const Bubble& b : gas.bubbles) sum += b.amount;
    return sum;
  }
};

double energy(const Bubble& b) { return b.pressure * b.volume / (b.exponent - 1); }

std::vector<GasEventKind> kinds(const std::vector<GasEvent>& events) {
  std::vector<GasEventKind> result;
  for (const GasEvent& e : events) result.push_back(e.kind);
  return result;
}
using Kinds = std::vector<GasEventKind>;

TEST(GasLabels, ConnectAcrossFacesOnlyAndCountAllGas) {
  Scene s({"####  #",  //
           "# ##  #",  //
           "#7 ####",  //
           "# 7#7 7",  //
           "#######"});
  label_gas(s.domain, s.total, eps, s.gas.region, s.labels);
  // Diagonal contact does not connect, nor do part-filled cells.
  ASSERT_EQ(s.labels.components.size(), 5u);
  double gas = 0;
  for (const GasComponent& part : s.labels.components) {
    EXPECT_FALSE(part.open);
    gas += part.volume;
  }
  const double liquid = testing::integral(s.domain.grid, s.total);
  EXPECT_NEAR(gas + liquid, 35, 1e-13);
  // The cells filled to 0.7 count in equal shares for the regions across their faces.
  EXPECT_NEAR(s.labels.components[0].volume, 1 + 0.15 + 0.1, 1e-14);
  EXPECT_NEAR(s.labels.components[1].volume, 1 + 0.3 + 0.3, 1e-14);
}

TEST(GasLabels, OpenAirAndThreadsAnd3d) {
  const Domain<3> domain = [] {
    Grid<3> grid = testing::box_grid(12);
    Sides<3> sides = testing::all_sides(grid, SideKind::free_slip);
    sides.at(2, 1).kind = SideKind::open;
    return Domain<3>(std::move(grid), sides);
  }();
  CellField total(domain.layout());
  testing::set_cells(domain.grid, total, [](const Vec<3>& x) {
    const double ball = testing::distance(x, Vec<3>{{0.5, 0.5, 0.4}});
    return x[2] > 0.85 || ball < 0.25 ? 0.0 : ball < 0.33 ? 0.6 : 1.0;
  });
  const CellLabels before(domain.layout());
  GasLabels one(domain.layout()), two(domain.layout());
  {
    const ThreadScope threads(1);
    label_gas(domain, total, eps, before, one);
  }
  const ThreadScope threads(3);
  label_gas(domain, total, eps, before, two);
  ASSERT_EQ(one.components.size(), 2u);
  EXPECT_FALSE(one.components[0].open);
  EXPECT_TRUE(one.components[1].open);
  double gas = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(one.components[k].volume, two.components[k].volume);
    gas += one.components[k].volume;
  }
  EXPECT_NEAR(gas + testing::integral(domain.grid, total), 1, 1e-13);
}

TEST(GasLabels, VolumeHasNoJumpWhereACellJoinsTheLiquid) {
  // One cell of the bubble fills up through the threshold of D, past half full, and up.
  Scene s({"######", "#    #", "######"});
  const int id = s.add_bubble(1, 5, 3);
  s.start();
  for (int tenths = 0; tenths < 100; ++tenths) {
    CellField later = s.total;
    const Cell c = s.domain.grid.cell({{4, 1}});
    later[c] = 0.01 * (tenths + 1);
    EXPECT_TRUE(advance_gas(s.domain, s.parameters, s.gas, s.total, later, 0.1, s.labels, s.next).empty());
    std::swap(s.gas, s.next);
    s.total = later;
    EXPECT_NEAR(s.bubble(id).volume, 4 - later[c], 1e-13);
    EXPECT_NEAR(s.bubble(id).pressure, 3 * std::pow(4 / (4 - later[c]), 1.4), 1e-12);
  }
}

TEST(GasRegions, SplitKeepsPressureAndGas) {
  Scene s({"########", "#      #", "########"});
  const int id = s.add_bubble(1, 7, 3);
  s.start();
  const double amount = s.amount();
  const std::vector<GasEvent> events = s.move_to({"########", "#  #   #", "########"});
  ASSERT_EQ(kinds(events), Kinds{GasEventKind::split});
  ASSERT_EQ(s.gas.bubbles.size(), 2u);
  const Bubble& large = s.bubble(id);
  const Bubble& small = s.bubble(events[0].other);
  EXPECT_DOUBLE_EQ(large.volume, 3);
  EXPECT_DOUBLE_EQ(small.volume, 2);
  const double pressure = 3 * std::pow(6.0 / 5.0, 1.4);
  EXPECT_NEAR(large.pressure, pressure, 1e-13);
  EXPECT_NEAR(small.pressure, pressure, 1e-13);
  EXPECT_NEAR(s.amount(), amount, 1e-14 * amount);
}

TEST(GasRegions, FilmThinnerThanHalfACellNeitherSplitsNorVents) {
  Scene s({"   ", "###", "# #", "# #", "# #", "###"}, true);
  const int id = s.add_bubble(1, 2, 3);
  for_each<Cell>(s.domain.layout(), s.domain.grid.cells(), [&](Cell c, const Index<2>& i) {
    if (i[1] == 5) s.gas.region[c] = open_air;
  });
  s.start();
  EXPECT_TRUE(s.move_to({"   ", "###", "# #", "#4#", "# #", "###"}).empty());
  EXPECT_NEAR(s.bubble(id).volume, 2.6, 1e-14);
  EXPECT_TRUE(s.move_to({"   ", "#1#", "# #", "#4#", "# #", "###"}).empty());
  EXPECT_EQ(s.gas.bubbles.size(), 1u);
  // A thicker film cuts the upper part off, which vents; the lower one keeps its gas.
  ASSERT_EQ(kinds(s.move_to({"   ", "# #", "# #", "#6#", "# #", "###"})), Kinds{GasEventKind::vented});
  EXPECT_LT(s.bubble(id).amount, 0.5 * 9);
  EXPECT_GT(s.bubble(id).amount, 0.4 * 9);
}

TEST(GasRegions, MergeConservesGasAndEnergy) {
  Scene s({"#########", "#  ##   #", "#########"});
  const int a = s.add_bubble(1, 3, 4, 1.3);
  const int b = s.add_bubble(5, 8, 2, 1.6);
  s.start();
  const double amount = s.amount();
  const double heat = energy(s.bubble(a)) + energy(s.bubble(b));
  const double capacity = s.bubble(a).amount / 0.3 + s.bubble(b).amount / 0.6;
  // The film goes elsewhere, so that the volume stays.
  const auto events = s.move_to({"#########", "#      ##", "#########"});
  ASSERT_EQ(kinds(events), Kinds{GasEventKind::merged});
  ASSERT_EQ(s.gas.bubbles.size(), 1u);
  const Bubble& merged = s.gas.bubbles.front();
  EXPECT_NEAR(merged.amount, amount, 1e-14 * amount);
  EXPECT_NEAR(merged.amount / (merged.exponent - 1), capacity, 1e-13 * capacity);
  // At the joint volume of 5 the energies add up; from there on the law is adiabatic.
  EXPECT_NEAR(merged.constant * std::pow(5, 1 - merged.exponent) / (merged.exponent - 1), heat, 1e-13 * heat);
  EXPECT_NEAR(merged.pressure * std::pow(6, merged.exponent), merged.constant, 1e-12);
}

TEST(GasRegions, VentAndCloseAgain) {
  Scene s({"     ", "#####", "#   #", "#####"}, true);
  const int id = s.add_bubble(0, 5, 3);
  for_each<Cell>(s.domain.layout(), s.domain.grid.cells(), [&](Cell c, const Index<2>& i) {
    if (i[1] == 3) s.gas.region[c] = open_air;
  });
  s.start();
  EXPECT_EQ(s.bubble(id).volume, 3);
  const auto vented = s.move_to({"     ", "## ##", "#   #", "#####"});
  ASSERT_EQ(kinds(vented), Kinds{GasEventKind::vented});
  EXPECT_EQ(vented[0].bubble, id);
  EXPECT_TRUE(s.gas.bubbles.empty());

  // What closes again keeps the ambient pressure, or is a bubble of ambient gas.
  s.parameters.trapped.adiabatic = true;
  EXPECT_TRUE(s.move_to({"     ", "## ##", "#   #", "#####"}).empty());
  const auto closed = s.move_to({"     ", "#####", "#   #", "#####"});
  ASSERT_EQ(kinds(closed), Kinds{GasEventKind::closed});
  EXPECT_DOUBLE_EQ(s.bubble(closed[0].bubble).pressure, 1);
  EXPECT_TRUE(s.move_to({"     ", "#####", "#  ##", "#####"}).empty());
  EXPECT_NEAR(s.bubble(closed[0].bubble).pressure, std::pow(1.5, 1.4), 1e-13);
}

TEST(GasRegions, ShrunkenBubbleHoldsACellOpenAndThenGoesToItsNeighbour) {
  Scene s({"########", "# ##   #", "########"});
  const int small = s.add_bubble(1, 2, 3);
  const int large = s.add_bubble(4, 7, 3);
  s.start();
  const double amount = s.amount();
  EXPECT_TRUE(s.move_to({"########", "#3##   #", "########"}).empty());
  ASSERT_EQ(s.gas.held_open.size(), 2u);  // one of every bubble
  CellMask liquid(s.domain.layout(), 1);
  hold_open(s.domain.grid, s.gas, liquid);
  EXPECT_EQ(liquid[s.domain.grid.cell({{1, 1}})], 0);
  EXPECT_NEAR(s.bubble(small).pressure, 3 * std::pow(1 / 0.7, 1.4), 1e-13);
  const auto events = s.move_to({"########", "#8##   #", "########"});
  ASSERT_EQ(kinds(events), Kinds{GasEventKind::absorbed});
  EXPECT_EQ(events[0].other, large);
  EXPECT_NEAR(s.amount(), amount, 1e-14);
  EXPECT_NEAR(s.bubble(large).volume, 3.2, 1e-14);
  EXPECT_EQ(s.gas.held_open.size(), 1u);
}

TEST(GasRegions, BubbleThatMovesOnByACellKeepsItsId) {
  Scene s({"#####", "# ###", "#####"});
  const int id = s.add_bubble(1, 2, 3);
  s.start();
  EXPECT_TRUE(s.move_to({"#####", "## ##", "#####"}).empty());
  EXPECT_EQ(s.bubble(id).volume, 1);
}

TEST(GasRegions, MeanPressureDoesTheWorkOfTheGas) {
  Bubble b = join({{6, 1.3, 2, 3}});
  const double before = energy(b);
  change_volume(b, 2.2);
  EXPECT_NEAR(b.mean_pressure * 0.2, before - energy(b), 1e-7 * before);
}

TEST(GasRegions, NodePressureIsTheMeanOfTheCellsOutsideD) {
  Scene s({"#####", "# # #", "#####"});
  const int a = s.add_bubble(1, 2, 3);
  s.add_bubble(3, 4, 5);
  s.start();
  s.total[s.domain.grid.cell({{2, 1}})] = 1;
  CellMask liquid(s.domain.layout());
  mark_liquid(s.domain.grid, s.total, eps, liquid);
  NodeField nodes(s.domain.layout());
  gas_pressure_on_nodes(s.domain, s.parameters, s.gas, liquid, false, nodes);
  const auto node = [&](int i, int k) { return nodes[low_node(s.domain.grid.cell({{i, k}}))]; };
  EXPECT_EQ(node(1, 1), s.bubble(a).pressure);
  EXPECT_EQ(node(3, 2), 5);
  EXPECT_EQ(node(0, 0), 1);
}

}  // namespace
}  // namespace quicksand
