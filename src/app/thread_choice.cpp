#include "app/thread_choice.hpp"

#include <algorithm>

namespace quicksand {

void ThreadChoice::step_took(double seconds) {
  ++steps_;
  thread_steps_ += next();
  if (fixed_) return;
  if (!on_trial()) {
    if (--wait_ == 0) choose_other();
    return;
  }
  (place_ % 2 == 1 ? seconds_other_ : seconds_in_use_) += seconds;
  if (++place_ == 2 * pairs || (place_ == 2 && is_decided())) conclude();
}

bool ThreadChoice::is_decided() const {
  return std::max(seconds_in_use_, seconds_other_) > decisive * std::min(seconds_in_use_, seconds_other_);
}

void ThreadChoice::choose_other() {
  smaller_ = in_use_ == most_ || (in_use_ > 1 && !smaller_);
  other_ = smaller_ ? (in_use_ + 1) / 2 : std::min(2 * in_use_, most_);
}

void ThreadChoice::conclude() {
  if (seconds_other_ < clearly * seconds_in_use_) {
    in_use_ = other_;
    // Where fewer were better still fewer may be: the next trial goes the same way, and soon.
    smaller_ = !smaller_;
    wait_ = 1;
    next_wait_ = shortest_wait;
  } else {
    wait_ = next_wait_;
    next_wait_ = std::min(2 * next_wait_, longest_wait);
  }
  place_ = 0;
  seconds_in_use_ = seconds_other_ = 0;
}

}  // namespace quicksand
