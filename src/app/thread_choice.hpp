#pragma once
/// \file
/// How many of its threads a run uses.
#include <map>

namespace quicksand {

/// Finds out, as a run goes on, with how many threads its steps take least: all, half of them, a quarter ... one. On a
/// busy machine, and where loops are short, fewer may be faster. Results do not depend on the number.
///
/// Trials put steps with the number in use and with the next smaller or larger one in turns, so that both meet the same
/// work and the same neighbours; three pairs that agree decide. They are far between, and farther when they confirm
/// what is in use.
///
/// On a busy machine a step may take ten times as long with all threads as with one, since each loop waits for the last
/// of them. Hence steps have a time limit, after which fewer threads finish them. A larger number on trial that runs
/// into it has lost; one in use is put on trial, where it loses those pairs in which it does so again.
class ThreadChoice {
 public:
  /// \param most   threads that may be used, at least 1
  /// \param fixed  use all of them, whatever they take
  ThreadChoice(int most, bool fixed);

  /// Threads for the next step.
  int next() const;
  /// Seconds that the next step has with so many; infinite where it is not known what fewer take.
  double time_limit() const;
  /// Threads that finish the next step when its time is over.
  int fewer() const;
  /// To be called after a step. \param seconds  that it took
  void step_took(double seconds);
  /// What steps took counts no more: they are others from now on.
  void forget();
  /// Mean number of threads that steps so far began with.
  double mean() const { return steps_ > 0 ? thread_steps_ / static_cast<double>(steps_) : most_; }

 private:
  static constexpr int enough = 3;          ///< pairs of steps that decide a trial
  static constexpr int first_wait = 1;      ///< steps before the first trial: the first is not like the others
  static constexpr int shortest_wait = 32;  ///< steps between trials
  static constexpr int longest_wait = 512;
  static constexpr double clearly = 0.95;  ///< of the time in use has to be beaten
  static constexpr double patience = 1.5;  ///< time limit, in that of a step with fewer threads

  bool on_trial() const { return !fixed_ && wait_ == 0; }
  void begin_trial(int other);
  /// Of a pair of steps. \param late  whether the one with more threads ran into the time limit
  void judge(bool late);

  int most_;
  bool fixed_;
  int in_use_;
  int wait_ = first_wait;
  int next_wait_ = shortest_wait;
  bool down_next_ = false;  ///< direction of the next trial where there are two

  int other_ = 1;  ///< on trial
  int place_ = 0;  ///< of the step in its trial: even ones take the smaller number
  int for_other_ = 0;
  int against_other_ = 0;
  double seconds_in_use_ = 0;
  double seconds_other_ = 0;
  double late_seconds_ = 0;  ///< of the step that began the trial by running into its time limit, or 0

  std::map<int, double> last_seconds_;  ///< of a step within its time limit, by number of threads
  long steps_ = 0;
  double thread_steps_ = 0;
};

}  // namespace quicksand
