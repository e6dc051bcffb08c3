#pragma once
/// \file
/// Running a case.
#include "app/case_config.hpp"

namespace quicksand {

/// How a case is run.
struct RunOptions {
  int threads = 0;     ///< 0: as many as OpenMP chooses
  bool quiet = false;  ///< no progress
};

/// Runs a case to its end, or to the end of the step in which SIGINT or SIGTERM arrives, and writes its results to
/// config.output.directory, which exists and may be written to. `summary.json` tells how the run ended, also where this
/// throws. \return exit code of the program: 0, or 128 + the signal \throws NumericalError, FileError
int run_case(const CaseConfig& config, const RunOptions& options);

}  // namespace quicksand
