#pragma once
/// \file
/// Shipped cases, built and advanced as the program does.
#include <string>
#include <vector>

#include "app/build_flow.hpp"
#include "app/case_config.hpp"
#include "app/time_control.hpp"
#include "core/threads.hpp"
#include "physics/diagnostics.hpp"
#include "physics/time_step.hpp"

namespace quicksand::testing {

/// A case below configs/, such as "slug/case_e".
inline CaseConfig shipped_case(const std::string& name, const std::vector<std::string>& settings = {}) {
  return read_case(std::string(QUICKSAND_SOURCE_DIR) + "/configs/" + name + ".yaml", settings);
}

/// The case with steps by CFL number instead of its own.
inline CaseConfig with_cfl(CaseConfig config, double cfl = 0.3, double max_step = 0.005) {
  config.time.step.reset();
  config.time.cfl = cfl;
  config.time.max_step = max_step;
  return config;
}

/// The case with `factor` times the cells along every axis.
inline CaseConfig refined(CaseConfig config, int factor) {
  for (auto* axis : {&config.grid.x, &config.grid.y, &config.grid.z}) {
    for (AxisSegment& segment : *axis) segment.cells *= factor;
  }
  return config;
}

/// Runs the flow of a case to its end, or as far as after(report) returns true.
template <int Dim, class After>
void run(const CaseConfig& config, Flow<Dim>& flow, After&& after) {
  TimeControl control(config.time, config.output.fields);
  control.output_due(0);
  while (!control.finished(flow.state().time)) {
    const double stable = stable_step(flow, control.cfl());
    const StepReport report = flow.advance(control.next_step(flow.state().time, flow.state().dt, stable));
    control.output_due(flow.state().time);
    if (!after(report)) return;
  }
}

template <int Dim>
void run(const CaseConfig& config, Flow<Dim>& flow) {
  run(config, flow, [](const StepReport&) { return true; });
}

}  // namespace quicksand::testing
