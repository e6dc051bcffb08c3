// Sizes of time steps and times of output.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/time_control.hpp"
#include "core/errors.hpp"

namespace quicksand {
namespace {

TimeSettings fixed_steps(double end, double step) {
  TimeSettings time;
  time.end = end;
  time.step = step;
  return time;
}

TimeSettings cfl_steps(double end, double max_step) {
  TimeSettings time;
  time.end = end;
  time.cfl = 0.5;
  time.max_step = max_step;
  return time;
}

/// The steps of a run and the times at which fields are due.
struct Steps {
  std::vector<double> dt;
  std::vector<double> outputs;
  double end = 0;
};

Steps take_steps(const TimeSettings& time, const OutputSchedule& fields, const std::function<double(double)>& stable) {
  TimeControl control(time, fields);
  Steps steps;
  double now = 0;
  if (control.output_due(0)) steps.outputs.push_back(0);
  while (!control.finished(now)) {
    steps.dt.push_back(control.next_step(now, steps.dt.empty() ? 0 : steps.dt.back(), stable(now)));
    now += steps.dt.back();
    if (control.output_due(now)) steps.outputs.push_back(now);
    if (steps.dt.size() > 10'000'000) throw std::logic_error("the run does not end");
  }
  steps.end = now;
  return steps;
}

double unlimited(double) { return INFINITY; }
double wavering(double now) { return 0.013 + 0.01 * std::sin(37 * now); }

TEST(TimeControl, FixedStepsFillTheRunWithoutASliver) {
  for (const auto& [end, step] :
       {std::pair{4.0, 5e-4}, {1.0, 0.1}, {0.3, 0.1}, {1.0, 1.0 / 3}, {0.7, 7e-6}, {1.0, 1.0}}) {
    SCOPED_TRACE(step);
    const Steps steps = take_steps(fixed_steps(end, step), {}, unlimited);
    EXPECT_EQ(static_cast<double>(steps.dt.size()), std::round(end / step));
    EXPECT_DOUBLE_EQ(steps.end, end);
    EXPECT_NEAR(*std::min_element(steps.dt.begin(), steps.dt.end()), step, 1e-3 * step);
    EXPECT_NEAR(*std::max_element(steps.dt.begin(), steps.dt.end()), step, 1e-3 * step);
  }
}

TEST(TimeControl, LastFixedStepIsTheRest) {
  const Steps steps = take_steps(fixed_steps(1, 0.3), {}, unlimited);
  ASSERT_EQ(steps.dt.size(), 4u);
  EXPECT_NEAR(steps.dt.back(), 0.1, 1e-14);
}

TEST(TimeControl, FieldsOfFixedStepsAreOnTime) {
  OutputSchedule fields;
  fields.every = 0.1;
  const Steps steps = take_steps(fixed_steps(2, 1e-5), fields, unlimited);
  ASSERT_EQ(steps.outputs.size(), 21u);
  for (std::size_t i = 0; i < steps.outputs.size(); ++i) {
    EXPECT_NEAR(steps.outputs[i], 0.1 * static_cast<double>(i), 1e-8);
  }
}

TEST(TimeControl, StepsByCflNumberHitOutputsAndEnd) {
  OutputSchedule every;
  every.every = 0.1;
  const Steps steps = take_steps(cfl_steps(0.75, 0.017), every, wavering);
  ASSERT_EQ(steps.outputs.size(), 8u);
  for (std::size_t i = 0; i < steps.outputs.size(); ++i) {
    EXPECT_DOUBLE_EQ(steps.outputs[i], 0.1 * static_cast<double>(i));
  }
  EXPECT_DOUBLE_EQ(steps.end, 0.75);

  OutputSchedule times;
  times.times = {0.05, 1.0 / 3, 0.75};
  const Steps listed = take_steps(cfl_steps(0.75, 0.017), times, wavering);
  ASSERT_EQ(listed.outputs.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(listed.outputs[i], times.times[i]);
}

TEST(TimeControl, StepsByCflNumberStayWithinTheirLimits) {
  OutputSchedule fields;
  fields.every = 0.1;
  const Steps steps = take_steps(cfl_steps(1, 0.017), fields, [](double) { return 0.013; });
  EXPECT_DOUBLE_EQ(steps.dt.front(), 0.0013) << "from rest the first step is short";
  for (std::size_t i = 1; i < steps.dt.size(); ++i) {
    EXPECT_LE(steps.dt[i], 0.013 * 1.001);
    EXPECT_LE(steps.dt[i], steps.dt[i - 1] * 1.3 * 1.001);
    EXPECT_GE(steps.dt[i], 0.0013) << "no sliver";
  }
}

TEST(TimeControl, FixedStepsBeyondTheLimitAreTold) {
  const TimeControl fixed(fixed_steps(1, 0.1), {});
  EXPECT_EQ(fixed.cfl(), 1);
  EXPECT_EQ(fixed.next_step(0, 0, 0.01), 0.1);
  EXPECT_TRUE(fixed.beyond_limit(0.1, 0.01));
  EXPECT_FALSE(fixed.beyond_limit(0.1, 0.2));
  EXPECT_FALSE(TimeControl(cfl_steps(1, 0.1), {}).beyond_limit(0.1, 0.0999));
}

TEST(TimeControl, StepsThatAreTooShortAreRefused) {
  TimeSettings time = cfl_steps(2, 0.1);
  EXPECT_EQ(TimeControl(time, {}).least_step(), 2e-12);
  time.min_step = 1e-3;
  const TimeControl control(time, {});
  EXPECT_EQ(control.least_step(), 1e-3);
  EXPECT_THROW(control.next_step(0, 0.1, 1e-4), NumericalError);
  EXPECT_THROW(TimeControl(fixed_steps(1, 1e-20), {}).next_step(0.5, 1e-20, 1), NumericalError);
}

TEST(SteadyState, IsReachedByWhatDecays) {
  // |u| = 1 - exp(-t): time |du/dt| / |u| falls below 1e-3 at t = 9.1.
  SteadyState steady(1e-3);
  double time = 0;
  StepReport report;
  do {
    time += 0.1;
    report.momentum_norm = 1 - std::exp(-time);
    report.momentum_change = std::exp(-time);
  } while (!steady.reached(report, time) && time < 100);
  EXPECT_NEAR(time, 9.1, 0.1);
}

TEST(SteadyState, IsNotReachedByWhatGrows) {
  SteadyState steady(1e-2);
  StepReport report;
  for (double time = 0.1; time < 1e6; time *= 1.1) {
    report.momentum_norm = std::sqrt(time);
    report.momentum_change = 0.5 / std::sqrt(time);
    EXPECT_FALSE(steady.reached(report, time));
  }
  EXPECT_NEAR(steady.unsteadiness(), 0.5, 1e-12);
}

TEST(SteadyState, RestIsSteadyAndWithoutToleranceNothingIs) {
  SteadyState steady(1e-2);
  EXPECT_TRUE(steady.reached(StepReport{}, 1));
  SteadyState endless(std::nullopt);
  EXPECT_FALSE(endless.reached(StepReport{}, 1));
}

}  // namespace
}  // namespace quicksand
