#pragma once
/// \file
/// The files of a result folder.
#include <filesystem>
#include <optional>

#include "app/bubble_writer.hpp"
#include "app/case_config.hpp"
#include "app/crater_writer.hpp"
#include "core/snapshot.hpp"
#include "core/text_output.hpp"
#include "core/xdmf.hpp"
#include "physics/diagnostics.hpp"
#include "physics/flow.hpp"

namespace quicksand {

/// Writes `case.yaml` at once, then fields, history lines and the summary as the run goes.
template <int Dim>
class ResultWriter {
 public:
  /// \throws FileError
  ResultWriter(const CaseConfig& config, std::filesystem::path folder);

  /// Field file of the current state, and its crater; returns the file's path. \throws FileError
  std::filesystem::path write_fields(const Flow<Dim>& flow);
  /// The current state under a name of its own, for looking at what went wrong. \throws FileError
  std::filesystem::path write_failed_state(const Flow<Dim>& flow);
  /// One line of `history.csv`, those of `bubbles.csv` and `events.csv`, and the crater when it is due.
  /// \throws FileError
  void append_history(const Flow<Dim>& flow, const Diagnostics& diagnostics, const StepReport& report);
  /// `summary.json`. \throws FileError
  void write_summary(const Json& summary);

 private:
  FieldSnapshot snapshot(const Flow<Dim>& flow) const;

  const CaseConfig& config_;
  std::filesystem::path folder_;
  XdmfSeries series_;
  std::optional<CsvWriter> history_;
  std::optional<BubbleWriter<Dim>> bubbles_;  ///< where there can be bubbles
  std::optional<CraterWriter<Dim>> crater_;
};

}  // namespace quicksand
