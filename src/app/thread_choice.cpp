#include "app/thread_choice.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace quicksand {

ThreadChoice::ThreadChoice(int most, bool fixed)
    : most_(most),
      fixed_(fixed || most == 1),
      // To find out that more are no better takes less than the other way round: their steps have a time limit.
      in_use_(fixed_ ? most : (most + 1) / 2) {}

int ThreadChoice::next() const {
  if (!on_trial()) return in_use_;
  return place_ % 2 == 0 ? std::min(in_use_, other_) : std::max(in_use_, other_);
}

int ThreadChoice::fewer() const {
  const auto known = last_seconds_.lower_bound(next());
  return known != last_seconds_.begin() ? std::prev(known)->first : 1;
}

double ThreadChoice::time_limit() const {
  const auto known = last_seconds_.find(fewer());
  const bool limited = !fixed_ && known != last_seconds_.end() && known->first < next();
  return limited ? patience * known->second : std::numeric_limits<double>::infinity();
}

void ThreadChoice::step_took(double seconds) {
  const int threads = next();
  const int with_fewer = fewer();
  const bool late = seconds > time_limit();
  // What the smaller number takes now is what the larger one of the pair goes by.
  if (!late || (on_trial() && place_ % 2 == 0)) last_seconds_[threads] = seconds;
  ++steps_;
  thread_steps_ += threads;
  if (fixed_) return;
  if (on_trial()) {
    (threads == in_use_ ? seconds_in_use_ : seconds_other_) = seconds;
    if (++place_ % 2 == 0) judge(late);
  } else if (late) {
    // It may just have been longer than those before it.
    begin_trial(with_fewer);
    late_seconds_ = seconds;
  } else if (--wait_ == 0) {
    const bool down = in_use_ == most_ || (in_use_ > 1 && down_next_);
    begin_trial(down ? (in_use_ + 1) / 2 : std::min(2 * in_use_, most_));
  }
}

void ThreadChoice::forget() {
  last_seconds_.clear();
  wait_ = first_wait;
  next_wait_ = shortest_wait;
}

void ThreadChoice::begin_trial(int other) {
  other_ = other;
  wait_ = place_ = for_other_ = against_other_ = 0;
  late_seconds_ = 0;
}

void ThreadChoice::judge(bool late) {
  const bool better = late ? other_ < in_use_ : seconds_other_ < clearly * seconds_in_use_;
  ++(better ? for_other_ : against_other_);
  if (for_other_ == enough) {
    // Where fewer were better still fewer may be: the next trial goes the same way, and soon.
    down_next_ = other_ < in_use_;
    in_use_ = other_;
    wait_ = 1;
    next_wait_ = shortest_wait;
  } else if (against_other_ == enough || (late && !better)) {
    // The step that made the trial was just long, and others may be; but a stop of the machine is not to count.
    if (late_seconds_ > 0) {
      double& last = last_seconds_[other_];
      last = std::clamp(late_seconds_, last, 2 * last);
    }
    down_next_ = other_ > in_use_;
    wait_ = next_wait_;
    next_wait_ = std::min(2 * next_wait_, longest_wait);
  }
}

}  // namespace quicksand
