#pragma once
/// \file
/// What a run remembers besides its flow.
#include "app/run_statistics.hpp"
#include "app/time_control.hpp"

namespace quicksand {

/// Everything of a run that outlives a step and is not in the flow. When outputs are due follows from the time.
struct RunMemory {
  SteadyState steady;
  bool is_steady = false;
  RunStatistics statistics;
  int stage = 0;  ///< number of the grid that the run is on

  void exchange(Archive& archive) {
    steady.exchange(archive);
    carry(archive, "run/is_steady", is_steady);
    statistics.exchange(archive);
    carry(archive, "run/stage", stage);
  }
};

}  // namespace quicksand
