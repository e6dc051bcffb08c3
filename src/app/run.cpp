#include "app/run.hpp"

#include <chrono>
#include <filesystem>
#include <new>
#include <optional>
#include <utility>

#include "app/build_flow.hpp"
#include "app/checkpoint_schedule.hpp"
#include "app/checkpoints.hpp"
#include "app/interrupt.hpp"
#include "app/output_folder.hpp"
#include "app/progress.hpp"
#include "app/result_writer.hpp"
#include "app/step_retry.hpp"
#include "app/thread_choice.hpp"
#include "core/errors.hpp"
#include "core/threads.hpp"
#include "physics/remap.hpp"
#include "physics/time_step.hpp"

namespace quicksand {

namespace {

/// A run on its way: the parts that the functions below share.
template <int Dim>
struct Run {
  const CaseConfig& config;
  RunMemory<Dim> memory;
  TimeControl control;
  ResultWriter<Dim> writer;
  Progress& progress;
  ThreadChoice threads;
  std::vector<GasEvent> remap_events{};  ///< since the last step
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <int Dim>
void write_fields(const Flow<Dim>& flow, Run<Dim>& run) {
  run.progress.wrote(flow.state().time, flow.state().step, run.writer.write_fields(flow).string());
  run.writer.append_crater(flow);
}

/// Takes note of the grid that the flow is on now.
template <int Dim>
void begin_grid(const Flow<Dim>& flow, Run<Dim>& run) {
  const Index<Dim>& cells = flow.domain().grid.global_cells();
  std::string text;
  long count = 1;
  for (int d = 0; d < Dim; ++d) {
    text += (d > 0 ? " x " : "") + std::to_string(cells[d]);
    count *= cells[d];
  }
  run.memory.statistics.begin_grid(text, count, flow.state().time);
  run.threads.forget();
  run.progress.begin_grid(count);
  if (run.memory.grids.number() == 1) return;
  run.progress.say("grid " + std::to_string(run.memory.grids.number()) + " at t = " + number_text(flow.state().time) +
                   ": " + text + " cells, the smallest " + number_text(flow.domain().grid.smallest_width()));
}

/// Moves the flow to the next grid when its time has come.
template <int Dim>
void change_grid(Flow<Dim>& flow, Run<Dim>& run) {
  std::optional<Domain<Dim>> domain = run.memory.grids.next(flow);
  if (!domain) return;
  RemapReport report;
  flow = remap(flow, std::move(*domain), report);
  run.remap_events = report.gas;
  begin_grid(flow, run);
  if (report.kinetic_energy < report.kinetic_energy_before) {
    run.progress.say("the change of grid kept " + number_text(report.kinetic_energy / report.kinetic_energy_before) +
                     " of the kinetic energy");
  }
}

/// One step, after a change of grid that is due, and what is written after it. \return whether fields were
template <int Dim>
bool take_step(Flow<Dim>& flow, Run<Dim>& run) {
  const auto start = std::chrono::steady_clock::now();
  change_grid(flow, run);
  const auto grid_ready = std::chrono::steady_clock::now();
  const ThreadScope threads(run.threads.next(), run.threads.time_limit(), run.threads.fewer());
  const State<Dim>& state = flow.state();
  const double stable = stable_step(flow, run.control.cfl());
  StepReport report =
      advance_with_retries(flow, run.control.next_step(state.time, state.dt, stable),
                           {run.config.guard.halvings, run.control.least_step()}, [&](const std::string& failure) {
                             run.progress.say(failure);
                             run.memory.statistics.count_retry();
                           });
  run.threads.step_took(seconds_since(grid_ready));
  report.gas.insert(report.gas.begin(), run.remap_events.begin(), run.remap_events.end());
  run.remap_events.clear();
  if (run.control.beyond_limit(state.dt, stable) && run.memory.statistics.count_step_beyond_cfl() == 1) {
    run.progress.say("warning: step " + std::to_string(state.step) + ": dt " + number_text(state.dt) +
                     " exceeds the CFL limit of convection, " + number_text(stable) +
                     "; further such steps are only counted, in summary.json");
  }
  run.memory.statistics.add(report, flow.volume(), state.time);
  run.memory.is_steady = run.memory.steady.reached(report, state.time);
  run.writer.append_history(flow, diagnose(flow), report);
  for (const GasEvent& event : report.gas) {
    run.progress.say(event_text(event, state.time, full_circle(flow.domain().grid)));
  }
  run.progress.step(state.time, state.step, state.dt);
  run.memory.statistics.add_step_seconds(seconds_since(start));
  const bool due = run.control.output_due(state.time);
  if (due) write_fields(flow, run);
  return due;
}

template <int Dim>
bool is_over(const Flow<Dim>& flow, const Run<Dim>& run) {
  return run.memory.is_steady || run.control.finished(flow.state().time);
}

template <int Dim>
void write_checkpoint(Flow<Dim>& flow, Run<Dim>& run, bool fields_due) {
  run.writer.sync();
  const std::filesystem::path file =
      quicksand::write_checkpoint(run.config.output.directory, run.config, fields_due, run.memory, flow);
  run.progress.wrote(flow.state().time, flow.state().step, file.string());
}

/// The flow at the start of the run, its first results written, or as the checkpoint has it.
template <int Dim>
Flow<Dim> begin(Run<Dim>& run, const ResumePoint* resume) {
  if (resume != nullptr) {
    Flow<Dim> flow = read_checkpoint<Dim>(*resume->reader, run.config, run.memory);
    run.control.output_due(flow.state().time);
    run.progress.begin_grid(flow.domain().grid.cells().size());
    run.progress.say("resumed from " + resume->reader->path().string());
    return flow;
  }
  Flow<Dim> flow = build_flow<Dim>(run.config, run.memory.grids.first());
  begin_grid(flow, run);
  run.memory.statistics.start(flow.volume());
  run.control.output_due(0);
  write_fields(flow, run);
  run.writer.append_history(flow, diagnose(flow), StepReport{});
  return flow;
}

/// Takes all steps, or as many as the user lets it. \return whether the end was reached
template <int Dim>
bool march(Run<Dim>& run, const ResumePoint* resume) {
  Flow<Dim> flow = begin(run, resume);
  CheckpointSchedule checkpoints(run.config.output.checkpoint, flow.state().time);
  bool fields_due = resume == nullptr || resume->head.fields_due;
  try {
    while (!is_over(flow, run) && interrupt_signal() == 0) {
      fields_due = take_step(flow, run);
      if (checkpoints.due(flow.state().time)) write_checkpoint(flow, run, fields_due);
    }
  } catch (const NumericalError& error) {
    const std::vector<std::filesystem::path> files = run.writer.write_failed_step(flow);
    throw NumericalError("step " + std::to_string(flow.state().step + 1) + " at time " +
                         number_text(flow.state().time) + ": " + error.what() + "; the state before it is in " +
                         files.front().string() +
                         (files.size() > 1 ? ", what it came to in " + files.back().string() : ""));
  }
  const bool over = is_over(flow, run);
  // Fields of an interruption go when the run is resumed; tables may hold nothing that does not belong to the results.
  if (!over || run.config.output.checkpoint.every) write_checkpoint(flow, run, fields_due);
  if (!fields_due && over) write_fields(flow, run);
  if (!fields_due && !over) run.writer.write_fields(flow);
  return over;
}

/// Leaves a summary of a run that is about to end with an error, if it can still be written.
template <int Dim>
void summarize_failure(Run<Dim>& run, const std::string& message) {
  try {
    run.writer.write_summary(run.memory.statistics.summary("failed", message));
  } catch (const FileError&) {
    // The error that ended the run is the one to report.
  }
}

template <int Dim>
std::string steadiness_text(const Run<Dim>& run) {
  return std::string(run.memory.is_steady ? "the flow is steady" : "warning: the flow is not steady yet") +
         ", time |du/dt| / max |u| = " + number_text(run.memory.steady.unsteadiness());
}

template <int Dim>
int run_in(const CaseConfig& config, const RunOptions& options) {
  const std::string& folder = config.output.directory;
  std::vector<std::string> species;
  for (const Species& s : config.species) species.push_back(s.name);
  Progress progress(config.time.end, options.quiet);
  std::optional<ResumePoint> resume;
  if (options.resume) {
    resume = find_resume_point(folder, config, [&](const std::string& text) { progress.say(text); });
    rewind_output_folder(folder, resume->head.step, resume->head.fields_due);
  }
  std::vector<double> stage_ends;
  for (const StageConfig& stage : config.stages) stage_ends.push_back(stage.until);
  // Made one by one: g++ 12 destroys members of an aggregate twice when a later one throws.
  RunMemory<Dim> memory{GridSequence<Dim>(config), SteadyState(config.time.until_steady), false,
                        RunStatistics(species)};
  ResultWriter<Dim> writer(config, folder, resume ? std::optional(resume->head.step) : std::nullopt);
  TimeControl control(config.time, config.output.fields, stage_ends);
  Run<Dim> run{config,
               std::move(memory),
               std::move(control),
               std::move(writer),
               progress,
               ThreadChoice(thread_count(), options.fixed_threads)};
  bool finished = false;
  try {
    finished = march(run, resume ? &*resume : nullptr);
  } catch (const std::bad_alloc&) {
    summarize_failure(run, "out of memory");
    throw;
  } catch (const std::exception& error) {
    summarize_failure(run, error.what());
    throw;
  }
  run.memory.statistics.note_threads(run.threads.mean());
  if (run.memory.steady.wanted()) {
    run.memory.statistics.note_steadiness(run.memory.is_steady, run.memory.steady.unsteadiness());
    if (finished) run.progress.say(steadiness_text(run));
  }
  const std::string status = finished ? "finished" : "interrupted";
  run.writer.write_summary(
      run.memory.statistics.summary(status, finished ? "" : "by signal " + std::to_string(interrupt_signal())));
  // Without an interval they are there for interruptions only.
  if (finished && !config.output.checkpoint.every) remove_checkpoints(folder);
  run.progress.say(status + " after " + std::to_string(run.memory.statistics.steps()) + " steps; results in " + folder);
  return finished ? 0 : 128 + interrupt_signal();
}

}  // namespace

int run_case(const CaseConfig& config, const RunOptions& options) {
  set_threads(options.threads);
  catch_interrupts();
  return config.grid.dimension == 2 ? run_in<2>(config, options) : run_in<3>(config, options);
}

}  // namespace quicksand
