#include "app/run_statistics.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <string>

#include "core/threads.hpp"

namespace quicksand {

namespace {

std::size_t at(Phase phase) { return static_cast<std::size_t>(phase); }

/// Largest memory in use so far, in MiB.
double peak_memory() {
  // What getrusage() says may be that of the process that started this one.
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key; status.ignore(std::numeric_limits<std::streamsize>::max(), '\n')) {
    double kibibytes = 0;
    if (key == "VmHWM:" && status >> kibibytes) return kibibytes / 1024;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::array<int, phase_names.size()> iterations_of(const StepReport& report) {
  std::array<int, phase_names.size()> n{};
  n[at(Phase::mac_projection)] = report.mac.iterations;
  for (const ObstacleReport& obstacle : report.obstacle) n[at(Phase::redistribute_volume)] += obstacle.iterations;
  n[at(Phase::redistribute_momentum)] = report.momentum.iterations;
  n[at(Phase::diffusion)] = report.diffusion.iterations;
  n[at(Phase::projection)] = report.projection.iterations;
  return n;
}

}  // namespace

RunStatistics::RunStatistics(std::vector<std::string> species)
    : species_(std::move(species)), volume_error_(species_.size(), 0.0) {}

void RunStatistics::begin_grid(const std::string& cells_text, long cells, double time) {
  grids_.push_back({cells_text, cells, time});
}

void RunStatistics::start(std::vector<double> volume) { initial_volume_ = std::move(volume); }

void RunStatistics::add(const StepReport& report, const std::vector<double>& volume, double time) {
  ++steps_;
  time_ = time;
  OnGrid& grid = grids_.back();
  ++grid.steps;
  cell_steps_ += static_cast<double>(grid.cells);
  const double start = std::accumulate(initial_volume_.begin(), initial_volume_.end(), 0.0);
  const double whole = std::max(start, report.liquid_volume);
  for (std::size_t i = 0; i < volume.size(); ++i) {
    volume_error_[i] = std::max(volume_error_[i], std::abs(volume[i] - initial_volume_[i]) / whole);
  }
  redistribution_rise_ = std::max(redistribution_rise_, report.redistribution_energy_change / report.energy_scale);
  projection_rise_ =
      std::max(projection_rise_, (report.projection_energy_change - report.gas_work) / report.energy_scale);
  const auto iterations = iterations_of(report);
  for (std::size_t k = 0; k < phase_names.size(); ++k) {
    seconds_[k] += report.seconds[k];
    grid.seconds[k] += report.seconds[k];
    iterations_[k] += iterations[k];
    most_iterations_[k] = std::max(most_iterations_[k], iterations[k]);
  }
  linear_iterations_ += report.diffusion.linear_iterations;
  fallbacks_ += report.diffusion.fell_back ? 1 : 0;
  stagnated_ += report.diffusion.stagnated ? 1 : 0;
  largest_gap_ = std::max(largest_gap_, report.diffusion.gap);
}

double RunStatistics::wall_seconds() const {
  return earlier_seconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void RunStatistics::carry_grids(Archive& archive) {
  carry(archive, "statistics/grid/cells", grids_, &OnGrid::cells);
  carry(archive, "statistics/grid/from", grids_, &OnGrid::from);
  carry(archive, "statistics/grid/steps", grids_, &OnGrid::steps);
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    const std::string name = "statistics/grid/" + std::to_string(i);
    archive.exchange(name + "/text", grids_[i].cells_text);
    carry_numbers(archive, name + "/seconds", grids_[i].seconds);
  }
  carry(archive, "statistics/cell_steps", cell_steps_);
  carry(archive, "statistics/step_seconds", step_seconds_);
  if (grids_.empty()) archive.refuse("statistics/grid/cells", "no grid that the run was on");
}

void RunStatistics::exchange(Archive& archive) {
  double wall = wall_seconds();
  carry(archive, "statistics/wall_seconds", wall);
  carry(archive, "statistics/resumptions", resumptions_);
  if (archive.loading()) {
    start_ = std::chrono::steady_clock::now();
    earlier_seconds_ = wall;
    ++resumptions_;
  }
  carry_grids(archive);
  carry(archive, "statistics/steps", steps_);
  carry(archive, "statistics/time", time_);
  carry(archive, "statistics/retries", retries_);
  carry(archive, "statistics/steps_beyond_cfl", steps_beyond_cfl_);
  carry(archive, "statistics/fallbacks", fallbacks_);
  carry(archive, "statistics/stagnated", stagnated_);
  carry(archive, "statistics/largest_gap", largest_gap_);
  initial_volume_.resize(species_.size());
  carry_numbers(archive, "statistics/initial_volume", initial_volume_);
  carry_numbers(archive, "statistics/volume_error", volume_error_);
  carry(archive, "statistics/redistribution_rise", redistribution_rise_);
  carry(archive, "statistics/projection_rise", projection_rise_);
  carry_numbers(archive, "statistics/seconds", seconds_);
  carry_numbers(archive, "statistics/iterations", iterations_);
  carry_numbers(archive, "statistics/most_iterations", most_iterations_);
  carry(archive, "statistics/linear_iterations", linear_iterations_);
}

Json RunStatistics::summary(const std::string& status, const std::string& message) const {
  const double wall = wall_seconds();
  Json json;
  json["status"] = status;
  if (!message.empty()) json["message"] = message;
  json["time"] = time_;
  json["steps"] = steps_;
  if (steadiness_) {
    json["steady"] = steadiness_->first;
    json["unsteadiness"] = steadiness_->second;
  }
  json["resumptions"] = resumptions_;
  json["retried_steps"] = retries_;
  json["steps_beyond_cfl"] = steps_beyond_cfl_;
  json["cells"] = grids_.back().cells;
  json["wall_seconds"] = wall;
  json["step_seconds"] = step_seconds_;
  json["cell_steps_per_second"] = wall > 0 ? cell_steps_ / wall : 0.0;
  json["threads"] = thread_count();
  if (mean_threads_) json["mean_threads"] = *mean_threads_;
  json["peak_memory_MiB"] = peak_memory();
  for (std::size_t i = 0; i < species_.size(); ++i) json["volume_error"][species_[i]] = volume_error_[i];
  json["energy_increase"]["redistribution"] = redistribution_rise_;
  json["energy_increase"]["projection"] = projection_rise_;
  const double cell_steps = std::max(cell_steps_, 1.0);
  for (std::size_t k = 0; k < phase_names.size(); ++k) {
    Json& phase = json["phases"][phase_names[k]];
    phase["seconds"] = seconds_[k];
    phase["microseconds_per_cell_step"] = 1e6 * seconds_[k] / cell_steps;
    phase["iterations"] = iterations_[k];
    phase["most_iterations_in_a_step"] = most_iterations_[k];
  }
  json["phases"]["diffusion"]["linear_iterations"] = linear_iterations_;
  json["phases"]["diffusion"]["fallbacks"] = fallbacks_;
  json["phases"]["diffusion"]["stagnated"] = stagnated_;
  json["phases"]["diffusion"]["largest_gap"] = largest_gap_;
  json["grids"] = Json::array();
  for (const OnGrid& grid : grids_) {
    Json entry;
    entry["cells"] = grid.cells_text;
    entry["from"] = grid.from;
    entry["steps"] = grid.steps;
    for (std::size_t k = 0; k < phase_names.size(); ++k) entry["seconds"][phase_names[k]] = grid.seconds[k];
    json["grids"].append(entry);
  }
  return json;
}

}  // namespace quicksand
