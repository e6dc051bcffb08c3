#pragma once
/// \file
/// How many of its threads a run uses.

namespace quicksand {

/// Finds out, as a run goes on, with how many threads its steps take least: all, half of them, a quarter ... one. On a
/// busy machine, and where loops are short, fewer may be faster. Results do not depend on the number.
///
/// Trials put steps with the number in use and with the next smaller or larger one in turns, so that both meet the same
/// work and the same neighbours. They are far between, and farther when they confirm what is in use; those that a first
/// pair of steps decides end with it, since on a busy machine a step with all threads may take ten times as long.
class ThreadChoice {
 public:
  /// \param most   threads that may be used, at least 1
  /// \param fixed  use all of them, whatever they take
  ThreadChoice(int most, bool fixed) : most_(most), fixed_(fixed || most == 1), in_use_(most) {}

  int most() const { return most_; }
  /// Threads for the next step.
  int next() const { return on_trial() && place_ % 2 == 1 ? other_ : in_use_; }
  /// To be called after a step. \param seconds  that it took
  void step_took(double seconds);
  /// Mean number of threads over the steps so far.
  double mean() const { return steps_ > 0 ? thread_steps_ / static_cast<double>(steps_) : most_; }

 private:
  static constexpr int pairs = 3;           ///< of steps in a trial
  static constexpr int first_wait = 1;      ///< steps before the first trial: the first is not like the others
  static constexpr int shortest_wait = 32;  ///< steps between trials
  static constexpr int longest_wait = 512;
  static constexpr double clearly = 0.95;  ///< of the time in use has to be beaten
  static constexpr double decisive = 2;    ///< ratio of two steps that ends a trial

  bool on_trial() const { return !fixed_ && wait_ == 0; }
  /// The next smaller number, and the next larger one, in turns.
  void choose_other();
  bool is_decided() const;
  void conclude();

  int most_;
  bool fixed_;
  int in_use_;
  int other_ = 1;
  bool smaller_ = false;  ///< whether the last trial was of a smaller number
  int place_ = 0;         ///< of the step in its trial
  int wait_ = first_wait;
  int next_wait_ = shortest_wait;
  double seconds_in_use_ = 0;
  double seconds_other_ = 0;
  long steps_ = 0;
  double thread_steps_ = 0;
};

}  // namespace quicksand
