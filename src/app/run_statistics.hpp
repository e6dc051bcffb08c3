#pragma once
/// \file
/// What a run adds up over its steps, for `summary.json`.
#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.hpp"
#include "core/text_output.hpp"
#include "physics/diagnostics.hpp"
#include "physics/flow.hpp"

namespace quicksand {

/// Sums and extremes over the steps of a run.
class RunStatistics {
 public:
  /// \param species  names
  explicit RunStatistics(std::vector<std::string> species);

  /// The steps that follow are on a grid with so many owned cells, from `time` on.
  void begin_grid(const std::string& cells_text, long cells, double time);

  /// Notes what the steps are compared with: Flow::volume() at the start.
  void start(std::vector<double> volume);
  /// Adds one accepted step.
  /// \param volume  Flow::volume() now
  /// \param time    after the step
  void add(const StepReport& report, const std::vector<double>& volume, double time);
  /// Adds the time on the wall that a step took, all but fields and checkpoints, which few steps write.
  void add_step_seconds(double seconds) { step_seconds_ += seconds; }
  void count_retry() { ++retries_; }
  /// Counts a fixed step beyond the CFL limit; returns how many there are.
  long count_step_beyond_cfl() { return ++steps_beyond_cfl_; }

  /// For runs that end when they are steady: whether they are, and SteadyState::unsteadiness().
  void note_steadiness(bool steady, double unsteadiness) { steadiness_ = {steady, unsteadiness}; }

  /// Mean number of threads since the run was started or resumed.
  void note_threads(double mean) { mean_threads_ = mean; }

  long steps() const { return steps_; }
  /// Hands everything over, the time on the wall so far included.
  void exchange(Archive& archive);

  /// The document of `summary.json`.
  Json summary(const std::string& status, const std::string& message) const;

 private:
  using PhaseSeconds = std::array<double, phase_names.size()>;

  double wall_seconds() const;
  void carry_grids(Archive& archive);

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double earlier_seconds_ = 0;  ///< on the wall, before the run was resumed
  long resumptions_ = 0;
  std::vector<std::string> species_;
  /// Steps and times on one grid of the run.
  struct OnGrid {
    std::string cells_text;
    long cells = 0;
    double from = 0;
    long steps = 0;
    PhaseSeconds seconds{};
  };
  std::vector<OnGrid> grids_;
  double cell_steps_ = 0;
  double step_seconds_ = 0;
  long steps_ = 0;
  double time_ = 0;
  long retries_ = 0;
  long steps_beyond_cfl_ = 0;
  long fallbacks_ = 0;
  std::optional<std::pair<bool, double>> steadiness_;
  std::optional<double> mean_threads_;
  long stagnated_ = 0;
  double largest_gap_ = 0;
  std::vector<double> initial_volume_;
  std::vector<double> volume_error_;
  double redistribution_rise_ = 0;
  double projection_rise_ = 0;
  PhaseSeconds seconds_{};
  std::array<long, phase_names.size()> iterations_{};
  std::array<int, phase_names.size()> most_iterations_{};
  long linear_iterations_ = 0;
};

}  // namespace quicksand
