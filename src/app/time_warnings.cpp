#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/case_start.hpp"
#include "app/case_warnings.hpp"
#include "core/config_node.hpp"

namespace quicksand {

namespace {

constexpr double most_cfl = 0.7;           ///< of violent flow
constexpr double most_steps = 2e6;         ///< of a run
constexpr double most_files = 1000;        ///< with fields
constexpr double least_period_steps = 20;  ///< per period of a wave

/// Doubles per cell in a file of fields, about.
constexpr double fields_per_file = 12;

double smallest_width(const CaseConfig& config) {
  double smallest = INFINITY;
  for (const auto* axis : {&config.grid.x, &config.grid.y, &config.grid.z}) {
    if (axis->empty()) continue;
    const std::vector<double> faces = make_faces(*axis);
    for (std::size_t i = 1; i < faces.size(); ++i) smallest = std::min(smallest, faces[i] - faces[i - 1]);
  }
  return smallest;
}

bool has_kind(const CaseConfig& config, SideKind kind) {
  const Boundaries& b = config.boundaries;
  const std::optional<SideConfig>* sides[] = {&b.x_min, &b.x_max, &b.y_min, &b.y_max, &b.z_min, &b.z_max};
  return std::any_of(std::begin(sides), std::end(sides),
                     [&](const auto* side) { return *side && (*side)->kind == kind; });
}

/// Speed that a fixed step must cope with: what is given, or what liquid that stands alone in the domain falls with.
double expected_speed(const CaseConfig& config) {
  const double g = std::abs(config.gravity[2]);
  const bool periodic = has_kind(config, SideKind::periodic);
  return std::max(given_speed(config), periodic ? 0.0 : std::sqrt(2 * g * fall_height(config)));
}

void warn_of_fixed_step(const CaseConfig& config, CaseWarnings& found) {
  const double h = smallest_width(config);
  const double speed = expected_speed(config);
  const double cells = speed * *config.time.step / h;
  if (cells <= 1) return;
  found.push_back({"time.step", "is " + brief(*config.time.step) + ": at the speed " + brief(speed) +
                                    " that gravity, sides or shapes give liquid, it moves " + brief(cells) +
                                    " cells of " + brief(h) + " in a step; usual is half a cell, a step of " +
                                    brief(h / (2 * speed)) + ", or cfl with max_step"});
}

/// Waves need steps that resolve their period.
void warn_of_waves(const CaseConfig& config, CaseWarnings& found) {
  const double step = config.time.step.value_or(config.time.max_step.value_or(0));
  const double g = std::abs(config.gravity[2]);
  for (const InitialFill& fill : config.initial) {
    const auto* wave = std::get_if<WaveShape>(&fill.shape);
    if (wave == nullptr || !(wave->wavenumber * g > 0)) continue;
    const double period = 2 * std::numbers::pi / std::sqrt(g * wave->wavenumber);
    if (step * least_period_steps <= period) continue;
    found.push_back({config.time.step ? "time.step" : "time.max_step",
                     "is " + brief(step) + ", and the wave's period is about " + brief(period) + ": fewer than " +
                         brief(least_period_steps) + " steps do not resolve it; usual are 100"});
    return;
  }
}

void warn_of_outputs(const CaseConfig& config, CaseWarnings& found) {
  const TimeSettings& time = config.time;
  const OutputSettings& output = config.output;
  const std::pair<const char*, std::optional<double>> intervals[] = {
      {"output.fields.every", output.fields.every},
      {"output.checkpoint.every", output.checkpoint.every},
      {"output.crater.every", output.crater ? output.crater->every : std::nullopt}};
  for (const auto& [path, every] : intervals) {
    if (every && *every > time.end) {
      found.push_back({path, "is " + brief(*every) + ", longer than the run, " + brief(time.end) +
                                 ": nothing is written on the way; usual is a part of the run"});
    }
  }
  if (!output.fields.every) return;
  const double files = time.end / *output.fields.every;
  if (files > most_files) {
    found.push_back(
        {"output.fields.every", "is " + brief(*output.fields.every) + ": about " + brief(std::floor(files)) +
                                    " files of fields until " + brief(time.end) + ", some " +
                                    brief(files * count_cells(config.grid) * fields_per_file * sizeof(double) / 1e6) +
                                    " MB; usual are 20 to 200 files"});
  }
  if (time.step && *output.fields.every < *time.step) {
    found.push_back({"output.fields.every", "is " + brief(*output.fields.every) + ", shorter than a step, " +
                                                brief(*time.step) +
                                                ": fields are written after each step; usual are "
                                                "many steps"});
  }
}

}  // namespace

void warn_of_time(const CaseConfig& config, CaseWarnings& found) {
  const TimeSettings& time = config.time;
  if (time.step) warn_of_fixed_step(config, found);
  // Parallel flows and flows to a steady state take longer steps.
  const bool violent = has_kind(config, SideKind::open) && !has_kind(config, SideKind::periodic) && !time.until_steady;
  if (time.cfl && *time.cfl > most_cfl && violent) {
    found.push_back({"time.cfl", "is " + brief(*time.cfl) +
                                     " cells per step: surfaces of violent flow lose accuracy; usual are 0.3 to 0.5"});
  }
  const double step = time.step.value_or(time.max_step.value_or(time.end));
  if (time.end / step > most_steps) {
    found.push_back(
        {time.step ? "time.step" : "time.max_step", "is " + brief(step) + ": the run takes " + brief(time.end / step) +
                                                        " steps or more; usual are thousands (is the unit right?)"});
  }
  warn_of_waves(config, found);
  warn_of_outputs(config, found);
}

}  // namespace quicksand
