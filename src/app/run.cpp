#include "app/run.hpp"

#include <cmath>
#include <filesystem>
#include <numbers>

#include "app/build_flow.hpp"
#include "app/progress.hpp"
#include "app/result_writer.hpp"
#include "app/run_statistics.hpp"
#include "app/time_control.hpp"
#include "core/errors.hpp"
#include "core/threads.hpp"
#include "physics/time_step.hpp"

namespace quicksand {

namespace {

/// A step that fails is tried again with half the size this often.
constexpr int most_halvings = 8;

template <int Dim>
std::vector<double> volumes_with_escaped(const Flow<Dim>& flow) {
  std::vector<double> volume;
  for (std::size_t i = 0; i < flow.state().phi.size(); ++i) {
    volume.push_back(species_volume(flow.domain().grid, flow.state().phi[i]) + flow.escaped()[i]);
  }
  return volume;
}

/// Advances by at most dt: a failed step is tried again with half of it. \throws NumericalError when all tries fail
template <int Dim>
StepReport advance_with_retries(Flow<Dim>& flow, double dt, RunStatistics& statistics, Progress& progress) {
  for (int halvings = 0;; ++halvings) {
    try {
      return flow.advance(dt);
    } catch (const NumericalError& error) {
      if (halvings == most_halvings) throw;
      progress.say("step " + std::to_string(flow.state().step + 1) + ": " + error.what() + "; trying again with dt " +
                   number_text(dt / 2));
      statistics.count_retry();
      dt /= 2;
    }
  }
}

template <int Dim>
int run_in(const CaseConfig& config, const RunOptions& options) {
  const std::filesystem::path folder = options.output.value_or(config.output.directory);
  Flow<Dim> flow = build_flow<Dim>(config);
  const double radians = flow.domain().grid.axisymmetric() ? 2 * std::numbers::pi : 1.0;
  const long cells = static_cast<long>(flow.domain().grid.cells().size());
  ResultWriter<Dim> writer(config, folder);
  TimeControl control(config.time, config.output.fields);
  RunStatistics statistics(volumes_with_escaped(flow), cells);
  Progress progress(config.time.end, cells, options.quiet);
  std::vector<std::string> species;
  for (const Species& s : config.species) species.push_back(s.name);

  const auto write_fields = [&] {
    progress.wrote(flow.state().time, flow.state().step, writer.write_fields(flow).string());
  };
  control.output_due(0);
  write_fields();
  writer.append_history(flow, diagnose(flow), StepReport{});
  try {
    while (!control.finished(flow.state().time)) {
      const State<Dim>& state = flow.state();
      const double stable = stable_step(flow, control.cfl());
      const StepReport report =
          advance_with_retries(flow, control.next_step(state.time, state.dt, stable), statistics, progress);
      const Diagnostics diagnostics = diagnose(flow);
      statistics.add(report, volumes_with_escaped(flow), diagnostics.kinetic_energy / radians,
                     diagnostics.potential_energy / radians);
      writer.append_history(flow, diagnostics, report);
      progress.step(state.time, state.step, state.dt);
      if (control.output_due(state.time) || control.finished(state.time)) write_fields();
    }
  } catch (const NumericalError& error) {
    const std::filesystem::path file = writer.write_failed_state(flow);
    const std::string message = "step " + std::to_string(flow.state().step + 1) + " at time " +
                                number_text(flow.state().time) + ": " + error.what();
    writer.write_summary(statistics.summary("failed", message, flow.state().time, species));
    throw NumericalError(message + "; the state before it is in " + file.string());
  }
  writer.write_summary(statistics.summary("finished", "", flow.state().time, species));
  progress.say("finished after " + std::to_string(flow.state().step) + " steps; results in " + folder.string());
  return 0;
}

}  // namespace

int run_case(const CaseConfig& config, const RunOptions& options) {
  set_threads(options.threads);
  return config.grid.dimension == 2 ? run_in<2>(config, options) : run_in<3>(config, options);
}

}  // namespace quicksand
