#pragma once
/// \file
/// What a run adds up over its steps, for `summary.json`.
#include <chrono>
#include <string>
#include <vector>

#include "core/text_output.hpp"
#include "physics/diagnostics.hpp"
#include "physics/flow.hpp"

namespace quicksand {

/// Sums and extremes over the steps of a run.
class RunStatistics {
 public:
  /// \param initial_volume  of every species, in the unit of species_volume()
  /// \param cells           owned cells
  RunStatistics(std::vector<double> initial_volume, long cells);

  /// Adds one accepted step.
  /// \param volume          of every species now, plus what has escaped
  /// \param kinetic_energy, total_energy  after the step
  void add(const StepReport& report, const std::vector<double>& volume, double kinetic_energy, double total_energy);
  void count_retry() { ++retries_; }

  /// Largest error so far of a species' volume, relative to the volume of all.
  double volume_error(std::size_t species) const { return volume_error_[species]; }
  double seconds() const;

  /// The document of `summary.json`.
  Json summary(const std::string& status, const std::string& message, double time,
               const std::vector<std::string>& species) const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  long cells_;
  long steps_ = 0;
  long retries_ = 0;
  long fallbacks_ = 0;
  std::vector<double> initial_volume_;
  std::vector<double> volume_error_;
  double redistribution_rise_ = 0;
  double projection_rise_ = 0;
  std::array<double, phase_names.size()> seconds_{};
  std::array<long, phase_names.size()> iterations_{};
  std::array<int, phase_names.size()> most_iterations_{};
  long linear_iterations_ = 0;
};

}  // namespace quicksand
