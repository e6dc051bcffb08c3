#pragma once
/// \file
/// Tables of the crater in a bed.
#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/case_config.hpp"
#include "core/text_output.hpp"
#include "physics/flow.hpp"

namespace quicksand {

/// Writes `crater.csv`, a line per output, and `crater_profiles.csv`, a line per output and column of cells. The flow
/// may have another grid at every output.
template <int Dim>
class CraterWriter {
 public:
  /// \param last_step  the step that a run goes on from: the tables keep their lines up to it, and the level is theirs;
  ///                   none: a new run
  /// \pre config.output.crater \throws FileError
  CraterWriter(const CaseConfig& config, const std::filesystem::path& folder,
               std::optional<std::int64_t> last_step = {});

  /// Adds the flow's crater, if it is not there yet. The first one, of the initial state, settles the level where the
  /// case does not. \throws FileError
  void append(const Flow<Dim>& flow);
  /// The same, at the first step that reaches another multiple of the case's interval. \throws FileError
  void append_when_due(const Flow<Dim>& flow);
  /// Brings all lines so far safely to the disk. \throws FileError
  void sync() const;

 private:
  CraterSettings settings_;
  std::vector<std::size_t> species_;
  CsvWriter crater_;
  CsvWriter profiles_;
  std::optional<double> level_;
  long last_step_ = -1;  ///< that was written
  double last_time_ = 0;
};

}  // namespace quicksand
