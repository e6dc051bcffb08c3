#include "app/thread_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace quicksand {
namespace {

/// Seconds of `steps` steps of which each takes cost(threads) seconds, and what its time limit leaves of it that of
/// fewer threads.
template <class Cost>
double run(ThreadChoice& choice, int steps, Cost&& cost) {
  double seconds = 0;
  for (int n = 0; n < steps; ++n) {
    double took = cost(choice.next());
    const double limit = choice.time_limit();
    if (took > limit) took = limit + (1 - limit / took) * cost(choice.fewer());
    seconds += took;
    choice.step_took(took);
  }
  return seconds;
}

TEST(ThreadChoice, KeepsAllThreadsWhereTheyAreFastest) {
  ThreadChoice choice(8, false);
  const double seconds = run(choice, 2000, [](int threads) { return 1.0 / threads; });
  EXPECT_LT(seconds, 1.02 * 2000 / 8);
  EXPECT_GT(choice.mean(), 7.9);
}

TEST(ThreadChoice, GoesDownToOneWhereThatIsFastest) {
  ThreadChoice choice(8, false);
  const double seconds = run(choice, 2000, [](int threads) { return 1.0 * threads; });
  EXPECT_LT(seconds, 1.1 * 2000);
  EXPECT_EQ(choice.next(), 1);
}

TEST(ThreadChoice, FindsANumberBetween) {
  ThreadChoice choice(12, false);  // tries 12, 6, 3, 2, 1
  const auto cost = [](int threads) { return 1 + 0.3 * std::abs(threads - 3); };
  run(choice, 300, cost);
  EXPECT_LT(run(choice, 2000, cost), 1.03 * 2000);
}

TEST(ThreadChoice, FollowsWhatChanges) {
  ThreadChoice choice(2, false);
  run(choice, 1000, [](int threads) { return 1.0 * threads; });
  EXPECT_EQ(choice.next(), 1);
  run(choice, 1100, [](int threads) { return 1.0 / threads; });  // the longest time between two trials, twice
  EXPECT_LT(run(choice, 1000, [](int threads) { return 1.0 / threads; }), 1.02 * 500);
}

TEST(ThreadChoice, StepsThatTakeTenTimesAsLongAreCutShort) {
  ThreadChoice choice(2, false);
  const auto cost = [](int threads) { return threads == 2 ? 10.0 : 1.0; };
  EXPECT_LT(run(choice, 200, cost), 1.04 * 200);
  EXPECT_LT(run(choice, 1000, cost), 1.01 * 1000);
}

TEST(ThreadChoice, ABusyMachineIsSeenAtOnce) {
  ThreadChoice choice(2, false);
  run(choice, 1000, [](int threads) { return 1.0 / threads; });
  EXPECT_EQ(choice.next(), 2);
  EXPECT_LT(run(choice, 10, [](int threads) { return threads == 2 ? 10.0 : 1.0; }), 15);
  EXPECT_EQ(choice.next(), 1);
}

TEST(ThreadChoice, StepsOfChangingLengthKeepTheirThreads) {
  ThreadChoice choice(2, false);
  double seconds = 0;
  double least = 0;
  for (int n = 0; n < 2000; ++n) {
    const double work = n % 7 == 0 ? 4 : 1;
    seconds += run(choice, 1, [&](int threads) { return work * (threads == 2 ? 0.55 : 1); });
    least += work * 0.55;
  }
  EXPECT_LT(seconds, 1.05 * least);
}

TEST(ThreadChoice, GrowingStepsKeepTheirThreads) {
  ThreadChoice choice(4, false);
  double seconds = 0;
  double least = 0;
  for (int n = 0; n < 4000; ++n) {
    const double work = std::exp(n / 500.0);
    seconds += run(choice, 1, [&](int threads) { return work / threads; });
    least += work / 4;
  }
  EXPECT_LT(seconds, 1.05 * least);
}

TEST(ThreadChoice, SmallDifferencesChangeNothing) {
  ThreadChoice choice(2, false);
  run(choice, 1000, [](int threads) { return threads == 2 ? 1.0 : 0.97; });
  EXPECT_GT(choice.mean(), 1.95);
}

TEST(ThreadChoice, IsNoneWhereTheNumberIsFixed) {
  for (const int most : {1, 4}) {
    ThreadChoice choice(most, true);
    run(choice, 100, [](int threads) { return 1.0 * threads; });
    EXPECT_EQ(choice.mean(), most);
  }
}

}  // namespace
}  // namespace quicksand
