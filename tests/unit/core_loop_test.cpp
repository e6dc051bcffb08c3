#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "core/field.hpp"
#include "core/loop.hpp"
#include "core/threads.hpp"
#include "support/grids.hpp"

namespace quicksand {
namespace {

/// Large enough for loops to use threads.
const Layout<2> plane(Index<2>{130, 110});
const Layout<3> space(Index<3>{33, 21, 19});

template <int Dim>
Box<Dim> owned(const Layout<Dim>& layout) {
  return {Index<Dim>{}, layout.cells()};
}

template <int Dim>
void expect_every_point_once(const Layout<Dim>& layout) {
  const ThreadScope threads(4);
  CellField plain(layout), indexed(layout), coloured(layout);
  const Box<Dim> box = owned(layout);
  for_each<Cell>(layout, box, [&](Cell c) { plain[c] += 1; });
  for_each<Cell>(layout, box, [&](Cell c, const Index<Dim>& i) { indexed[c] += c.n == layout.flat(i) ? 1 : 5; });
  for_each_coloured<Cell>(layout, box,
                          [&](Cell c, const Index<Dim>& i) { coloured[c] += c.n == layout.flat(i) ? 1 : 5; });
  for (std::ptrdiff_t n = 0; n < layout.size(); ++n) {
    const double once = box.contains(layout.multi(n)) ? 1 : 0;
    ASSERT_EQ(plain[Cell{n}], once);
    ASSERT_EQ(indexed[Cell{n}], once);
    ASSERT_EQ(coloured[Cell{n}], once);
  }
}

TEST(CoreLoop, VisitsEveryPointOfThePlaneOnce) { expect_every_point_once(plane); }
TEST(CoreLoop, VisitsEveryPointOfSpaceOnce) { expect_every_point_once(space); }
TEST(CoreLoop, VisitsEveryPointOfARingOnce) {
  for (const int n : {1, 2, 3, 130, 131}) expect_every_point_once(Layout<2>({n, 111}, {{true, true}}));
}

/// Every row adds to itself and to the rows next to it on the high side, as packs of elements do.
template <int Dim>
CellField add_to_rows_above(const Layout<Dim>& layout, int threads) {
  const ThreadScope of_loop(threads);
  CellField sums(layout);
  for_each_coloured_row(layout, owned(layout), 1 << Dim, [&](const Index<Dim>& row) {
    for (int k = 0; k < 1 << (Dim - 1); ++k) {
      Index<Dim> there = row;
      for (int d = 1; d < Dim; ++d) there[d] = layout.image(d, row[d] + ((k >> (d - 1)) & 1));
      const double part = testing::rough(row, k);
      for (int i = 0; i < layout.cells()[0]; ++i) sums[Cell{layout.flat(there) + i}] += part;
    }
  });
  return sums;
}

TEST(CoreLoop, EveryPieceIsDoneOnceByAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 7}) {
    const ThreadScope scope(threads);
    for (const std::ptrdiff_t count : {0, 1, 2, 5, 16, 1000}) {
      std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
      share_among_threads(count, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        for (std::ptrdiff_t i = first; i < last; ++i) ++visits[static_cast<std::size_t>(i)];
      });
      for (const std::atomic<int>& n : visits) EXPECT_EQ(n, 1);
    }
  }
}

TEST(CoreLoop, EveryPieceIsDoneByFewerThreadsThanAskedFor) {
  const ThreadScope scope(4);
  std::atomic<std::ptrdiff_t> visits = 0;
#pragma omp parallel num_threads(2)
#pragma omp single
  {
    // Within threads of OpenMP loops get no more of them.
    const ThreadScope inner(4);
    share_among_threads(1000, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
      EXPECT_EQ(omp_get_num_threads(), 1);
      visits += last - first;
    });
  }
  EXPECT_EQ(visits, 1000);
}

TEST(CoreLoop, ThreadsThatAreThroughHelpOthers) {
  if (omp_get_thread_limit() < 2) GTEST_SKIP() << "there is one thread only";
  const ThreadScope two(2);
  constexpr std::ptrdiff_t count = 1000;
  std::atomic<int> helped = 0;
  share_among_threads(count, [&](std::ptrdiff_t first, std::ptrdiff_t) {
    if (first >= count / 2) return;
    if (first > 0) {
      ++helped;
      return;
    }
    // The thread that the first half belongs to is held up.
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (helped == 0 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    EXPECT_GT(helped, 0);
  });
}

TEST(CoreLoop, ColouredRowsAddInTheSameOrderOnAnyNumberOfThreads) {
  const auto expect = [](const auto& layout) {
    CellField serial = add_to_rows_above(layout, 1);
    CellField threaded = add_to_rows_above(layout, 3);
    EXPECT_EQ(serial.values(), threaded.values());
    for (std::ptrdiff_t n = 0; n < layout.size(); ++n) {
      if (!owned(layout).contains(layout.multi(n))) continue;
      ASSERT_NE(serial[Cell{n}], 0) << n;
    }
  };
  expect(plane);
  expect(space);
  expect(Layout<3>({33, 21, 19}, {{true, true, true}}));
}

TEST(CoreField, CopiesAndFillsAreWholeOnAnyNumberOfThreads) {
  const Layout<2> large(Index<2>{400, 300});  // shared among threads
  for (const int count : {1, 3}) {
    const ThreadScope threads(count);
    CellField field(large, 2);
    for (std::ptrdiff_t n = 0; n < large.size(); ++n) field[Cell{n}] += static_cast<double>(n);
    CellField copy(field);
    EXPECT_EQ(copy.values(), field.values());
    CellField assigned(plane, 1);
    assigned = field;
    EXPECT_EQ(assigned.values(), field.values());
    const CellField& itself = assigned;
    assigned = itself;
    EXPECT_EQ(assigned.values(), field.values());
    assigned.fill(7);
    EXPECT_EQ(assigned.values(), CellField(large, 7).values());
    assigned = CellField();
    EXPECT_EQ(assigned.size(), 0);
  }
}

TEST(CoreLoop, EmptyBoxesAreNotVisited) {
  int visits = 0;
  const Box<2> flat{{0, 3}, {4, 3}};
  const Box<2> inverted{{4, 0}, {0, 4}};
  for (const Box<2>& box : {flat, inverted}) {
    for_each<Cell>(plane, box, [&](Cell) { ++visits; });
    for_each<Cell>(plane, box, [&](Cell, const Index<2>&) { ++visits; });
    for_each_coloured<Cell>(plane, box, [&](Cell, const Index<2>&) { ++visits; });
    EXPECT_EQ(sum<Cell>(plane, box, [](Cell) { return 1.0; }), 0);
  }
  EXPECT_EQ(visits, 0);
}

/// Adds a rough number of every cell to all nodes of the cell.
template <int Dim>
NodeField scatter(const Layout<Dim>& layout, int thread_number) {
  const ThreadScope threads(thread_number);
  NodeField nodes(layout);
  for_each_coloured<Cell>(layout, owned(layout), [&](Cell c, const Index<Dim>& i) {
    for (int k = 0; k < (1 << Dim); ++k) {
      Node n = low_node(c);
      for (int d = 0; d < Dim; ++d) n = n + ((k >> d) & 1) * layout.step(d);
      nodes[layout.image(n)] += testing::rough(i, 0.5) / (k + 1);
    }
  });
  return nodes;
}

template <int Dim>
void expect_scatter_without_races(const Layout<Dim>& layout) {
  const NodeField serial = scatter(layout, 1);
  for (int repeat = 0; repeat < 3; ++repeat) {
    const NodeField parallel = scatter(layout, 4);
    for (std::ptrdiff_t n = 0; n < layout.size(); ++n) ASSERT_EQ(serial[Node{n}], parallel[Node{n}]);
  }
}

TEST(CoreLoop, ColouredScatterInThePlaneHasNoRaces) { expect_scatter_without_races(plane); }
TEST(CoreLoop, ColouredScatterInSpaceHasNoRaces) { expect_scatter_without_races(space); }
TEST(CoreLoop, ColouredScatterRoundRingsHasNoRaces) {
  expect_scatter_without_races(Layout<2>({131, 111}, {{true, true}}));
  expect_scatter_without_races(Layout<3>({33, 21, 19}, {{false, true, true}}));
}

/// How many threads a loop over many points takes.
int team_size() {
  std::atomic<int> size = 0;
  share_among_threads(100000, [&](std::ptrdiff_t, std::ptrdiff_t) { size = omp_get_num_threads(); });
  return size;
}

TEST(ThreadScope, SetsTheNumberForItsLife) {
  const ThreadScope outer(3);
  {
    const ThreadScope inner(2);
    EXPECT_EQ(team_size(), 2);
  }
  EXPECT_EQ(team_size(), 3);
}

TEST(ThreadScope, LoopsBeyondItsTimeTakeFewerThreads) {
  const ThreadScope outer(3);
  {
    const ThreadScope spent(4, 0.0, 2);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    {
      const ThreadScope without_limit(3);
      EXPECT_EQ(team_size(), 3);
    }
    EXPECT_EQ(team_size(), 2);
    EXPECT_EQ(thread_count(), 2);
  }
  EXPECT_EQ(team_size(), 3);
  const ThreadScope in_time(2, 1e3);
  EXPECT_EQ(team_size(), 2);
  const ThreadScope fewer_than_it_may(1, 0.0, 2);
  EXPECT_EQ(team_size(), 1);
}

TEST(CoreLoop, SumsDoNotDependOnTheNumberOfThreads) {
  CellField f(space);
  for_each<Cell>(space, owned(space), [&](Cell c, const Index<3>& i) { f[c] = testing::rough(i, 2); });
  const auto total = [&](int n) {
    const ThreadScope threads(n);
    return sum<Cell>(space, owned(space), [&](Cell c) { return f[c]; });
  };
  const double one = total(1);
  EXPECT_NE(one, 0);
  EXPECT_EQ(total(2), one);
  EXPECT_EQ(total(3), one);
  EXPECT_EQ(total(4), one);
}

TEST(CoreLoop, MaximumFindsTheLargestAndKeepsTheFloor) {
  CellField f(plane, -1.0);
  f[Cell{plane.flat({129, 109})}] = 3;
  f[Cell{plane.flat({129, 110})}] = 9;  // a ghost cell
  const auto largest = [&](double floor) {
    return maximum<Cell>(plane, owned(plane), floor, [&](Cell c) { return f[c]; });
  };
  EXPECT_EQ(largest(0), 3);
  EXPECT_EQ(largest(4), 4);
}

}  // namespace
}  // namespace quicksand
