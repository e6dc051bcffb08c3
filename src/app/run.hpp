#pragma once
/// \file
/// Running a case.
#include <optional>
#include <string>

#include "app/case_config.hpp"

namespace quicksand {

/// What the command line says about a run beyond its case.
struct RunOptions {
  std::optional<std::string> output;  ///< folder instead of the case's
  int threads = 0;                    ///< 0: as many as OpenMP chooses
  bool overwrite = false;             ///< replace results in the output folder
  bool quiet = false;                 ///< no progress
};

/// Runs a case to its end and writes its results. The output folder exists and may be written to.
/// \return exit code of the program
/// \throws NumericalError, FileError
int run_case(const CaseConfig& config, const RunOptions& options);

}  // namespace quicksand
