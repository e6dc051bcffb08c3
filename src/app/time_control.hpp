#pragma once
/// \file
/// Sizes of time steps and times of output.
#include "app/case_config.hpp"

namespace quicksand {

/// Decides how long the next step is: the case's fixed step, or the stable one within its limits; shortened so that a
/// step ends at the end of the run and, with steps by CFL number, at every output time.
class TimeControl {
 public:
  TimeControl(const TimeSettings& time, const OutputSchedule& fields);

  /// CFL number of the case; for fixed steps what they are checked against.
  double cfl() const { return time_.cfl.value_or(1.0); }
  /// \param stable  the largest step by the CFL number
  /// \throws NumericalError when it falls below the case's min_step
  double next_step(double now, double last_dt, double stable) const;
  /// Whether the run is over.
  bool finished(double now) const;
  /// Whether fields are due now; says so once for each output time.
  bool output_due(double now);

 private:
  /// The earliest output time after those reported; infinite if there is none.
  double next_output() const;

  TimeSettings time_;
  OutputSchedule fields_;
  long outputs_done_ = 0;
};

}  // namespace quicksand
