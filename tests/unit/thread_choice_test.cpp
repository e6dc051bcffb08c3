#include "app/thread_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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
  EXPECT_LT(run(choice, 200, cost), 1.05 * 200);
  EXPECT_LT(run(choice, 1000, cost), 1.01 * 1000);
}

TEST(ThreadChoice, ABusyMachineIsSeenAtOnce) {
  ThreadChoice choice(2, false);
  run(choice, 1000, [](int threads) { return 1.0 / threads; });
  EXPECT_EQ(choice.next(), 2);
  EXPECT_LT(run(choice, 10, [](int threads) { return threads == 2 ? 10.0 : 1.0; }), 20);
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

TEST(ThreadChoice, StepsOfRandomLengthKeepTheirThreads) {
  for (const int most : {2, 4, 8}) {
    ThreadChoice choice(most, false);
    std::mt19937 random(3);
    std::normal_distribution<double> exponent(0, 0.45);
    double seconds = 0;
    double least = 0;
    for (int n = 0; n < 10000; ++n) {
      const double work = std::exp(exponent(random));
      const auto cost = [&](int threads) { return work * std::pow(threads, -0.8); };
      seconds += run(choice, 1, cost);
      least += cost(most);
    }
    EXPECT_LT(seconds, 1.05 * least) << most;
  }
}

TEST(ThreadChoice, AStopOfTheMachineDoesNotEndTheProtection) {
  ThreadChoice choice(2, false);
  run(choice, 200, [](int threads) { return 1.0 / threads; });
  run(choice, 1, [](int) { return 3600.0; });
  run(choice, 200, [](int threads) { return 1.0 / threads; });
  EXPECT_EQ(choice.next(), 2);
  EXPECT_LT(run(choice, 100, [](int threads) { return threads == 2 ? 10.0 : 1.0; }), 120);
}

TEST(ThreadChoice, LongerStepsOnAnotherGridAreNotTooLate) {
  ThreadChoice choice(2, false);
  run(choice, 200, [](int threads) { return 1.0 / threads; });
  choice.forget();
  EXPECT_LT(run(choice, 100, [](int threads) { return 16.0 / threads; }), 1.08 * 100 * 8);
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
  for (const int in_use : {1, 2}) {
    ThreadChoice choice(2, false);
    run(choice, 100, [=](int threads) { return threads == in_use ? 1.0 : 2.0; });
    run(choice, 1000, [=](int threads) { return threads == in_use ? 1.0 : 0.97; });
    EXPECT_NEAR(choice.mean(), in_use, 0.05);
  }
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
