#include "core/sparse_field.hpp"

#include <gtest/gtest.h>

namespace quicksand {
namespace {

TEST(CoreSparseField, HoldsWhatIsFoundAndCopiesAcrossTheEnds) {
  const Layout<2> ring({{5, 4}}, {{true, false}});
  const Box<2> cells{{}, ring.cells()};
  SparseField<Cell, int> field(ring);
  const auto at = [&](int x, int z) { return Cell{ring.flat({{x, z}})}; };
  EXPECT_FALSE(field.has(at(0, 0)));
  for (int round = 0; round < 2; ++round) {  // what is found anew replaces the old
    field.find(
        ring, cells, [&](Cell, const Index<2>& i) { return i[0] % 2 == round; },
        [](Cell, const Index<2>& i, int& value) {
          EXPECT_EQ(value, 0);
          value = 10 * i[0] + i[1];
          return i[1] < 3;
        });
    field.wrap(ring, cells);
    for (int x = -1; x <= 5; ++x) {
      const int image = ring.image(0, x);
      for (int z = 0; z < 4; ++z) {
        ASSERT_EQ(field.has(at(x, z)), image % 2 == round && z < 3) << x << " " << z;
        if (field.has(at(x, z))) {
          EXPECT_EQ(field[at(x, z)], 10 * image + z);
        }
      }
    }
  }
}

}  // namespace
}  // namespace quicksand
