#pragma once
/// \file
/// What a run remembers besides its flow.
#include "app/grid_sequence.hpp"
#include "app/run_statistics.hpp"
#include "app/time_control.hpp"

namespace quicksand {

/// Everything of a run that outlives a step and is not in the flow. When outputs are due follows from the time.
template <int Dim>
struct RunMemory {
  GridSequence<Dim> grids;
  SteadyState steady;
  bool is_steady = false;
  RunStatistics statistics;

  void exchange(Archive& archive) {
    grids.exchange(archive);
    steady.exchange(archive);
    carry(archive, "run/is_steady", is_steady);
    statistics.exchange(archive);
    // The case may ask for more steadiness by now.
    if (archive.loading()) is_steady = is_steady && steady.within_tolerance();
  }
};

}  // namespace quicksand
