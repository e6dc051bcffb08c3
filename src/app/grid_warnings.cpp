#include <algorithm>
#include <cmath>
#include <utility>

#include "app/case_start.hpp"
#include "app/case_warnings.hpp"
#include "core/config_node.hpp"

namespace quicksand {

namespace {

/// Ratio of the widths of neighbouring cells beyond which convection and surfaces lose accuracy.
constexpr double most_ratio = 1.3;

std::pair<std::string, const std::vector<AxisSegment>*> axis(const std::string& path,
                                                             const std::vector<AxisSegment>& segments) {
  return {path, &segments};
}

/// The largest ratio of neighbouring widths, with the place.
void warn_of_stretch(const std::vector<AxisSegment>& segments, const std::string& path, CaseWarnings& found) {
  if (segments.empty()) return;
  const std::vector<double> faces = make_faces(segments);
  double worst = 1;
  double place = 0;
  for (std::size_t i = 1; i + 1 < faces.size(); ++i) {
    const double ratio = (faces[i + 1] - faces[i]) / (faces[i] - faces[i - 1]);
    if (std::max(ratio, 1 / ratio) <= worst) continue;
    worst = std::max(ratio, 1 / ratio);
    place = faces[i];
  }
  if (worst <= most_ratio) return;
  found.push_back(
      {path, "neighbouring cells at " + brief(place) + " differ in width by a factor of " + brief(worst) +
                 ": surfaces that pass lose accuracy; usual are 1.05 to 1.2 (stretch: smooth, more cells)"});
}

}  // namespace

void warn_of_grid(const CaseConfig& config, CaseWarnings& found) {
  if (!fits(config)) {
    found.push_back({"grid", "the run needs about " + brief(needed_memory(config)) +
                                 " MB of memory, and this machine has " + brief(machine_memory()) +
                                 " MB: fewer cells, or another machine"});
  }
  std::vector axes{axis("grid.x", config.grid.x), axis("grid.y", config.grid.y), axis("grid.z", config.grid.z)};
  for (std::size_t i = 0; i < config.stages.size(); ++i) {
    const std::string path = child_path("stages", i) + ".grid.";
    const StageConfig::Axes& grid = config.stages[i].grid;
    axes.insert(axes.end(), {axis(path + "x", grid.x), axis(path + "y", grid.y), axis(path + "z", grid.z)});
  }
  for (const auto& [path, segments] : axes) warn_of_stretch(*segments, path, found);
  if (config.regrid && config.bubbles.empty() && config.charges.empty()) {
    found.push_back({"regrid", "does nothing without bubbles or charges, which its grids follow"});
  }
}

}  // namespace quicksand
