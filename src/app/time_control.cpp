#include "app/time_control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.hpp"
#include "core/text_output.hpp"

namespace quicksand {

namespace {

/// Steps grow at most so fast: a step that follows a retry or an impact should not jump back at once.
constexpr double largest_growth = 1.3;
/// The first step by CFL number starts from rest, where the stable one follows from gravity alone.
constexpr double first_step_share = 0.1;
/// What is left of a step's way to a given time may exceed the step by this share: far more than round-off adds up to
/// in the longest runs, far too little to matter for accuracy.
constexpr double step_slack = 1e-3;
/// Times closer than this, relative to the run's length, are the same.
constexpr double time_slack = 1e-12;

}  // namespace

bool SteadyState::reached(const StepReport& report, double time) {
  largest_norm_ = std::max(largest_norm_, report.momentum_norm);
  unsteadiness_ = largest_norm_ > 0 ? time * report.momentum_change / largest_norm_ : 0.0;
  return within_tolerance();
}

void SteadyState::exchange(Archive& archive) {
  carry(archive, "steady/largest_norm", largest_norm_);
  carry(archive, "steady/unsteadiness", unsteadiness_);
}

TimeControl::TimeControl(const TimeSettings& time, const OutputSchedule& fields, std::vector<double> stops)
    : time_(time), fields_(fields), stops_(std::move(stops)) {}

double TimeControl::next_output() const {
  if (fields_.every) return static_cast<double>(outputs_done_) * *fields_.every;
  const auto n = static_cast<std::size_t>(outputs_done_);
  return n < fields_.times.size() ? fields_.times[n] : std::numeric_limits<double>::infinity();
}

double TimeControl::next_stop(double now) const {
  double next = next_output() > now ? std::min(time_.end, next_output()) : time_.end;
  const double slack = time_slack * time_.end;
  for (const double stop : stops_) {
    if (stop > now + slack) next = std::min(next, stop);
  }
  return next;
}

double TimeControl::next_step(double now, double last_dt, double stable) const {
  const double left = time_.end - now;
  double dt = 0;
  double until = left;
  if (time_.step) {
    dt = *time_.step;
  } else {
    dt = std::min(stable, time_.max_step.value_or(left));
    dt = last_dt > 0 ? std::min(dt, largest_growth * last_dt) : first_step_share * dt;
    if (time_.min_step && stable < *time_.min_step) {
      throw NumericalError("the stable time step " + number_text(stable) + " is below time.min_step " +
                           number_text(*time_.min_step));
    }
    until = next_stop(now) - now;
  }
  if (dt * (1 + step_slack) >= until) {
    dt = until;
  } else if (!time_.step && dt > 0.5 * until) {
    dt = 0.5 * until;  // two equal steps rather than a long and a tiny one
  }
  if (!(now + dt > now)) {
    throw NumericalError("the time step " + number_text(dt) + " is too short to change the time " + number_text(now));
  }
  return dt;
}

double TimeControl::least_step() const { return std::max(time_.min_step.value_or(0), time_slack * time_.end); }

bool TimeControl::finished(double now) const { return now >= time_.end * (1 - time_slack); }

bool TimeControl::output_due(double now) {
  const double slack = time_.step ? step_slack * *time_.step : time_slack * time_.end;
  bool due = false;
  while (next_output() <= now + slack) {
    ++outputs_done_;
    due = true;
  }
  return due;
}

}  // namespace quicksand
