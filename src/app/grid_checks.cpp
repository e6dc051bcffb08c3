#include "app/grid_checks.hpp"

#include <cmath>

#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Most cells along an axis.
constexpr double most_axis_cells = 1e6;

void check_axis(const std::vector<AxisSegment>& segments, const std::string& path, Reading& reading) {
  if (segments.empty() || !reading.clean(path)) return;
  const bool list = reading.nearest(path).kind == ConfigNode::Kind::list;
  double before = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const AxisSegment& segment = segments[i];
    const std::string place = list ? child_path(path, i) : path;
    if (i == 0 && !segment.from) {
      reading.problem(place + ".from", "is required but missing: where the axis begins");
      continue;
    }
    const double from = segment.from.value_or(before);
    if (i > 0 && std::abs(from - before) > 1e-12 * std::max(std::abs(from), std::abs(before))) {
      reading.problem(place + ".from", "must be where the segment before ends, " + shortest(before) + ", not " +
                                           shortest(from) + " (or leave it out)");
    }
    if (!(from < segment.to)) {
      reading.problem(place + ".to", "must be greater than from = " + shortest(from) + ", not " + shortest(segment.to));
    }
    before = segment.to;
  }
  double cells = 0;
  for (const AxisSegment& segment : segments) cells += segment.cells;
  if (cells > most_axis_cells) {
    reading.problem(path, "has " + shortest(cells) + " cells; at most " + shortest(most_axis_cells));
  }
  if (!reading.clean(path)) return;
  try {
    make_faces(segments);
  } catch (const InputError& error) {
    reading.problem(path, error.what());
  }
}

/// Notes an axis of a stage that does not go where the case's does.
void check_ends(const std::vector<AxisSegment>& axis, const std::vector<AxisSegment>& whole, const std::string& path,
                Reading& reading) {
  check_axis(axis, path, reading);
  if (axis.empty() || whole.empty() || !reading.clean(path)) return;
  const double low = whole.front().from.value_or(0);
  const double high = whole.back().to;
  const double slack = 1e-12 * (high - low);
  if (std::abs(axis.front().from.value_or(0) - low) > slack || std::abs(axis.back().to - high) > slack) {
    reading.problem(path, "must go from " + shortest(low) + " to " + shortest(high) + " as the case's grid does, not " +
                              "from " + shortest(axis.front().from.value_or(0)) + " to " + shortest(axis.back().to));
  }
}

}  // namespace

void check_grid(const GridConfig& grid, Reading& reading) {
  if (reading.root().find("grid") == nullptr || !reading.clean("grid.dimension")) return;
  if (grid.dimension == 3) {
    if (reading.clean("grid.y") && grid.y.empty()) reading.problem("grid.y", "is required but missing: in 3-D");
    if (grid.geometry == Geometry::axisymmetric) {
      reading.problem("grid.geometry", "axisymmetric needs dimension: 2");
    }
    check_axis(grid.y, "grid.y", reading);
  } else if (!grid.y.empty()) {
    reading.problem("grid.y", "dimension: 2 has no y; its axes are x and z");
  }
  check_axis(grid.x, "grid.x", reading);
  check_axis(grid.z, "grid.z", reading);
  if (grid.geometry == Geometry::axisymmetric && reading.clean("grid.x") && !grid.x.empty() &&
      grid.x.front().from.value_or(0) < 0) {
    reading.problem("grid.x", "must not begin at a negative radius, " + shortest(*grid.x.front().from));
  }
  const double cells = count_cells(grid);
  if (cells > most_cells) reading.problem("grid", "has " + shortest(cells) + " cells; at most " + shortest(most_cells));
}

void check_stages(const CaseConfig& config, Reading& reading) {
  const Boundaries& b = config.boundaries;
  for (const auto* side : {&b.x_min, &b.y_min, &b.z_min}) {
    if (config.regrid && *side && (*side)->kind == SideKind::periodic) {
      reading.problem("regrid", "does not go with periodic sides");
    }
  }
  if (!reading.clean("grid")) return;
  for (std::size_t i = 0; i < config.stages.size(); ++i) {
    const StageConfig& stage = config.stages[i];
    const std::string path = child_path("stages", i);
    if (!reading.clean(path)) continue;
    check_ends(stage.grid.x, config.grid.x, path + ".grid.x", reading);
    check_ends(stage.grid.z, config.grid.z, path + ".grid.z", reading);
    if (config.grid.dimension == 3) {
      if (stage.grid.y.empty()) reading.problem(path + ".grid.y", "is required but missing: in 3-D");
      check_ends(stage.grid.y, config.grid.y, path + ".grid.y", reading);
    } else if (!stage.grid.y.empty()) {
      reading.problem(path + ".grid.y", "dimension: 2 has no y; its axes are x and z");
    }
    if (i > 0 && !(stage.until > config.stages[i - 1].until)) {
      reading.problem(path + ".until", "stages must follow each other: " + shortest(stage.until) + " comes after " +
                                           shortest(config.stages[i - 1].until));
    }
    if (reading.clean("time.end") && config.time.end > 0 && stage.until >= config.time.end) {
      reading.problem(path + ".until", "must be before the end of the run, " + shortest(config.time.end));
    }
  }
}

}  // namespace quicksand
