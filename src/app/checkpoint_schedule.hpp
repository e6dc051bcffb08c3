#pragma once
/// \file
/// When checkpoints are written.
#include <chrono>
#include <cmath>

#include "app/case_config.hpp"

namespace quicksand {

/// Tells after which steps a checkpoint is due: those that reach the next multiple of `every`, and the first one when
/// `wall_interval` has passed since the last checkpoint. Steps are not changed for it.
class CheckpointSchedule {
 public:
  /// \param time  of the flow at the start
  CheckpointSchedule(const CheckpointSettings& settings, double time) : settings_(settings), count_(count(time)) {}

  /// Says so once for each checkpoint. \param time  after a step
  bool due(double time) {
    const Clock::time_point now = Clock::now();
    const double reached = count(time);
    if (reached <= count_ && std::chrono::duration<double>(now - last_).count() < settings_.wall_interval) return false;
    count_ = reached;
    last_ = now;
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// A multiple that round-off has missed counts as reached.
  static constexpr double slack = 1e-9;
  double count(double time) const { return settings_.every ? std::floor(time / *settings_.every + slack) : 0.0; }

  CheckpointSettings settings_;
  double count_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace quicksand
