#pragma once
/// \file
/// Tables of the bubbles and of what happens to them.
#include <filesystem>
#include <string>

#include "core/text_output.hpp"
#include "physics/bubble_measures.hpp"

namespace quicksand {

/// One line of text about an event, for the log. \param time  after the step \param circle  2 pi in axisymmetric flows
std::string event_text(const GasEvent& event, double time, double circle);

/// Writes `bubbles.csv`, a line per bubble and step, and `events.csv`, a line per event.
template <int Dim>
class BubbleWriter {
 public:
  /// \throws FileError
  explicit BubbleWriter(const std::filesystem::path& folder);

  /// \throws FileError
  void append(const State<Dim>& state, const std::vector<BubbleMeasures<Dim>>& bubbles,
              const std::vector<GasEvent>& events, double circle);

 private:
  CsvWriter bubbles_;
  CsvWriter events_;
};

}  // namespace quicksand
