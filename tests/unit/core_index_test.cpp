#include <gtest/gtest.h>

#include "core/layout.hpp"
#include "core/loop.hpp"

namespace quicksand {
namespace {

TEST(CoreLayout, FlatAndMultiIndicesAreInverse) {
  const Layout<3> layout(Index<3>{4, 3, 2});
  EXPECT_EQ(layout.size(), 8 * 7 * 6);
  for (std::ptrdiff_t n = 0; n < layout.size(); ++n) EXPECT_EQ(layout.flat(layout.multi(n)), n);
}

TEST(CoreLayout, FirstAxisIsFastest) {
  const Layout<2> layout(Index<2>{5, 3});
  EXPECT_EQ(layout.step(0).n, 1);
  EXPECT_EQ(layout.step(1).n, 5 + 2 * ghosts);
  EXPECT_EQ(layout.flat({1, 0}) - layout.flat({0, 0}), layout.step(0).n);
  EXPECT_EQ(layout.flat({-1, 2}) - layout.flat({-1, 1}), layout.step(1).n);
}

TEST(CoreIndex, CellFaceAndNodeShareANumber) {
  const Cell c{17};
  EXPECT_EQ(high_cell(low_face(c)), c);
  EXPECT_EQ(high_cell(low_node(c)), c);
  EXPECT_EQ((c + Step{3} - Step{3}), c);
}

TEST(CoreBox, GrowExtendAndIntersect) {
  const Box<2> box{{0, 0}, {4, 2}};
  EXPECT_EQ(box.size(), 8);
  EXPECT_EQ(grow(box, 1), (Box<2>{{-1, -1}, {5, 3}}));
  EXPECT_EQ(grow(grow(box, 1), -1), box);
  EXPECT_EQ(extend_high(box, 1), (Box<2>{{0, 0}, {4, 3}}));
  EXPECT_EQ(intersect(box, Box<2>{{3, -5}, {9, 1}}), (Box<2>{{3, 0}, {4, 1}}));
  EXPECT_TRUE(intersect(box, Box<2>{{5, 0}, {9, 1}}).empty());
  EXPECT_TRUE(box.contains({3, 1}));
  EXPECT_FALSE(box.contains({4, 1}));
}

}  // namespace
}  // namespace quicksand
