#pragma once
/// \file
/// Sizes of time steps and times of output.
#include "app/case_config.hpp"
#include "core/archive.hpp"
#include "physics/flow.hpp"

namespace quicksand {

/// Tells when a flow has become steady: when time ||du/dt|| <= tolerance max ||u||, with the norm sqrt(sum m |u|^2) and
/// the largest one so far. What changes by a power of time never counts as steady, what decays exponentially does in
/// the end, and a flow that comes to rest is compared with how it moved.
class SteadyState {
 public:
  explicit SteadyState(std::optional<double> tolerance) : tolerance_(tolerance) {}

  /// Takes note of a step that ended at `time`. \returns whether the flow is steady; never without a tolerance
  bool reached(const StepReport& report, double time);
  /// time ||du/dt|| / max ||u|| of the last step; 0 for a flow that has not moved at all.
  double unsteadiness() const { return unsteadiness_; }
  bool wanted() const { return tolerance_.has_value(); }
  /// Whether the last step was steady enough.
  bool within_tolerance() const { return tolerance_ && unsteadiness_ <= *tolerance_; }
  /// Hands over what it has seen.
  void exchange(Archive& archive);

 private:
  std::optional<double> tolerance_;
  double largest_norm_ = 0;
  double unsteadiness_ = 0;
};

/// Decides how long the next step is: the case's fixed step whatever the CFL number, or the stable one within the
/// case's limits. A step is changed so that one ends at the end of the run and, with steps by CFL number, at every
/// output time and stop: it takes all that is left up to there when that is at most a thousandth longer than the step,
/// so that no sliver stays.
class TimeControl {
 public:
  /// \param stops  further times at which steps by CFL number end, increasing
  TimeControl(const TimeSettings& time, const OutputSchedule& fields, std::vector<double> stops = {});

  /// CFL number of the case; 1, the limit of convection, where steps are fixed.
  double cfl() const { return time_.cfl.value_or(1.0); }
  /// \param last_dt  step before, 0 for the first one
  /// \param stable   the largest step by the CFL number; fixed steps may exceed it, see beyond_limit()
  /// \throws NumericalError when `stable` falls below the case's min_step, or the step is too short to change the time
  double next_step(double now, double last_dt, double stable) const;
  /// Whether a fixed step was longer than the largest one by the CFL number.
  bool beyond_limit(double dt, double stable) const { return time_.step && dt > stable; }
  /// No step shorter than this is worth trying after a failure: min_step, and at least 1e-12 of the run.
  double least_step() const;
  /// Whether the run is over.
  bool finished(double now) const;
  /// Whether fields are due now; says so once for each output time. A fixed step is on time up to a thousandth of it.
  bool output_due(double now);

 private:
  /// The earliest output time after those reported; infinite if there is none.
  double next_output() const;
  /// The time after `now` at which a step must end.
  double next_stop(double now) const;

  TimeSettings time_;
  OutputSchedule fields_;
  std::vector<double> stops_;
  long outputs_done_ = 0;
};

}  // namespace quicksand
