// Banded Cholesky factors against the matrix they were made of, and the numbering that keeps bands narrow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/threads.hpp"
#include "solvers/banded_cholesky.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

/// A rough matrix of the given band whose diagonal dominates.
double entry(int row, int column, int bandwidth) {
  if (row == column) return 2.0 * bandwidth + 1.5;
  return std::abs(row - column) <= bandwidth ? testing::rough(Index<1>{{row + column}}, std::abs(row - column)) : 0.0;
}

/// Factors of a matrix of zeros.
BandedCholesky zeros(int size, int bandwidth) {
  BandedCholesky factors(size, bandwidth);
  for (int i = 0; i < size; ++i) factors.begin(i);
  return factors;
}

TEST(BandedCholesky, SolvesToRoundOff) {
  for (const auto& [size, bandwidth] :
       {std::pair{1, 0}, std::pair{7, 3}, std::pair{40, 11}, std::pair{5, 9}, std::pair{12, 0}, std::pair{50, 1},
        std::pair{48, 6}, std::pair{49, 6}, std::pair{97, 6}, std::pair{400, 41}, std::pair{30, 1}, std::pair{30, 2},
        std::pair{31, 4}, std::pair{33, 5}, std::pair{90, 7}, std::pair{90, 8}, std::pair{95, 9}, std::pair{99, 10}}) {
    BandedCholesky factors = zeros(size, bandwidth);
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j <= i; ++j) {
        if (i - j <= bandwidth) factors.add(i, j, entry(i, j, bandwidth));
      }
    }
    ASSERT_TRUE(factors.factorize());
    std::vector<double> b;
    for (int i = 0; i < size; ++i) b.push_back(std::sin(i + 1.0));
    std::vector<double> x = b;
    factors.solve(x);
    ASSERT_EQ(x.size(), b.size());
    for (int i = 0; i < size; ++i) {
      double product = 0;
      for (int j = 0; j < size; ++j) product += entry(i, j, bandwidth) * x[static_cast<std::size_t>(j)];
      EXPECT_NEAR(product, b[static_cast<std::size_t>(i)], 1e-13);
    }
  }
}

/// Every entry belongs to one of its two unknowns, and beginning another unknown leaves it alone.
TEST(BandedCholesky, UnknownsAreBegunOneByOne) {
  constexpr int size = 61;  // of an odd half, so that a cell of two unknowns lies in both
  constexpr int bandwidth = 5;
  BandedCholesky factors(size, bandwidth);
  for (int i = size - 1; i >= 0; --i) {
    factors.begin(i);
    for (int j = std::max(i - bandwidth, 0); j <= std::min(i + bandwidth, size - 1); ++j) {
      EXPECT_EQ(factors.owner(i, j), factors.owner(j, i));
      if (factors.owner(i, j) == i) factors.add(i, j, entry(i, j, bandwidth));
    }
  }
  ASSERT_TRUE(factors.factorize());
  std::vector<double> x(size, 1.0);
  factors.solve(x);
  for (int i = 0; i < size; ++i) {
    double product = 0;
    for (int j = 0; j < size; ++j) product += entry(i, j, bandwidth) * x[static_cast<std::size_t>(j)];
    EXPECT_NEAR(product, 1, 1e-13);
  }
}

TEST(BandedCholesky, RefusesWhatIsNotPositiveDefinite) {
  BandedCholesky factors = zeros(2, 1);
  factors.add(0, 0, 1);
  factors.add(1, 1, 1);
  factors.add(1, 0, 2);
  EXPECT_FALSE(factors.factorize());
}

/// In the lower half, between the halves, in the upper half.
TEST(BandedCholesky, RefusesAWrongPivotAnywhere) {
  constexpr int size = 101;
  for (const int wrong : {3, 50, 51, 97}) {
    BandedCholesky factors = zeros(size, 3);
    for (int i = 0; i < size; ++i) factors.add(i, i, i == wrong ? -1 : 1);
    EXPECT_FALSE(factors.factorize()) << wrong;
  }
  // The upper half alone makes the middle indefinite.
  BandedCholesky factors = zeros(size, 3);
  for (int i = 0; i < size; ++i) factors.add(i, i, 1);
  factors.add(52, 50, 1.5);
  EXPECT_FALSE(factors.factorize());
}

TEST(BandedCholesky, SolutionsDoNotDependOnTheNumberOfThreads) {
  constexpr int size = 6000;
  constexpr int bandwidth = 35;
  std::vector<double> solutions[2];
  for (const int threads : {1, 3}) {
    const ThreadScope of_factors(threads);
    BandedCholesky factors = zeros(size, bandwidth);
    for (int i = 0; i < size; ++i) {
      for (int j = std::max(i - bandwidth, 0); j <= i; ++j) factors.add(i, j, entry(i, j, bandwidth));
    }
    ASSERT_TRUE(factors.factorize());
    std::vector<double>& x = solutions[threads == 1 ? 0 : 1];
    for (int i = 0; i < size; ++i) x.push_back(std::sin(i + 1.0));
    factors.solve(x);
  }
  EXPECT_EQ(solutions[0], solutions[1]);
  for (int i = 0; i < size; ++i) {
    double product = 0;
    for (int j = std::max(i - bandwidth, 0); j <= std::min(i + bandwidth, size - 1); ++j) {
      product += entry(i, j, bandwidth) * solutions[0][static_cast<std::size_t>(j)];
    }
    ASSERT_NEAR(product, std::sin(i + 1.0), 1e-12);
  }
}

TEST(BandOrder, NumbersEveryPointOnceAndKeepsNeighboursNear) {
  for (const bool periodic : {false, true}) {
    const Layout<2> layout(Index<2>{{9, 4}}, AxisFlags<2>{{periodic, periodic}});
    const Box<2> box{Index<2>{}, layout.cells()};
    const BandOrder<2> order(layout, box);
    EXPECT_LE(order.bandwidth(), periodic ? 2 * 4 + 2 : 4 + 1);
    std::vector<int> visits(36, 0);
    order.for_each<Cell>([&](Cell, const Index<2>& i, int n) {
      ++visits.at(static_cast<std::size_t>(n));
      for (int k = 0; k < 9; ++k) {
        const int other = order.number(i + Index<2>{{k % 3 - 1, k / 3 - 1}});
        EXPECT_LE(other < 0 ? 0 : std::abs(other - n), order.bandwidth());
        EXPECT_TRUE(other >= 0 || !periodic);
      }
    });
    EXPECT_EQ(visits, std::vector<int>(36, 1));
  }
}

}  // namespace
}  // namespace quicksand
