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
  /// \param last_step  as of CsvWriter \throws FileError
  explicit BubbleWriter(const std::filesystem::path& folder, std::optional<std::int64_t> last_step = {});

  /// \throws FileError
  void append(const State<Dim>& state, const std::vector<BubbleMeasures<Dim>>& bubbles,
              const std::vector<GasEvent>& events, double circle);
  /// Brings all lines so far safely to the disk. \throws FileError
  void sync() const;

 private:
  CsvWriter bubbles_;
  CsvWriter events_;
};

}  // namespace quicksand
