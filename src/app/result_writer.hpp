#pragma once
/// \file
/// The files of a result folder.
#include <filesystem>
#include <optional>
#include <utility>

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
  /// \param last_step  the step that a run goes on from: tables keep their lines up to it; none: a new run
  /// \throws FileError
  ResultWriter(const CaseConfig& config, std::filesystem::path folder, std::optional<std::int64_t> last_step = {});

  /// Field file of the current state; returns its path. \throws FileError
  std::filesystem::path write_fields(const Flow<Dim>& flow);
  /// The crater of the current state, as it belongs to fields. \throws FileError
  void append_crater(const Flow<Dim>& flow);
  /// When a run can't go on: its state and, if a step has failed, what that had come to, under names of their own.
  /// \throws FileError
  std::vector<std::filesystem::path> write_failed_step(const Flow<Dim>& flow);
  /// One line of `history.csv`, those of `bubbles.csv` and `events.csv`, and the crater when it is due.
  /// \throws FileError
  void append_history(const Flow<Dim>& flow, const Diagnostics& diagnostics, const StepReport& report);
  /// Brings the tables safely to the disk: before a checkpoint, which counts on them. \throws FileError
  void sync() const;
  /// `summary.json`. \throws FileError
  void write_summary(const Json& summary);

 private:
  /// Fractions, density, velocity and pressure of a state on the flow's grid.
  FieldSnapshot snapshot(const Flow<Dim>& flow, const State<Dim>& state) const;
  /// The same of the flow's own state, with gas regions and stresses.
  FieldSnapshot snapshot(const Flow<Dim>& flow) const;

  const CaseConfig& config_;
  std::filesystem::path folder_;
  XdmfSeries series_;
  std::optional<CsvWriter> history_;
  std::optional<BubbleWriter<Dim>> bubbles_;  ///< where there can be bubbles
  std::optional<CraterWriter<Dim>> crater_;
};

}  // namespace quicksand
