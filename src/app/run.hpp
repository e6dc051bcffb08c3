#pragma once
/// \file
/// Running a case.
#include "app/case_config.hpp"

namespace quicksand {

/// How a case is run.
struct RunOptions {
  int threads = 0;             ///< at most; 0: as many as OpenMP chooses
  bool fixed_threads = false;  ///< always so many
  bool quiet = false;          ///< no progress
  bool resume = false;         ///< go on from the last checkpoint in the output folder
};

/// Runs a case to its end, or to the end of the step in which SIGINT or SIGTERM arrives, with a checkpoint then, and
/// writes its results to config.output.directory, which exists and may be written to. `summary.json` tells how the run
/// ended, also where this throws. A run that is resumed ends with the same results as one that was never interrupted.
/// \return exit code of the program: 0, or 128 + the signal
/// \throws NumericalError, FileError; InputError where there is no checkpoint of the case to resume from
int run_case(const CaseConfig& config, const RunOptions& options);

}  // namespace quicksand
