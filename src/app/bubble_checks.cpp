#include "app/bubble_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/grid_checks.hpp"
#include "app/grid_sequence.hpp"
#include "app/initial_bubbles.hpp"
#include "app/shape_checks.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Lengths below this part of the domain's size are rounding.
constexpr double rounding = 1e-9;

/// Gaps below this part of a bubble's radius count as none.
constexpr double touching = 1e-6;

/// Most cells of a refined grid along an axis, if all had the width around the bubbles.
constexpr double most_widths = 1e6;

/// Points across a ball, per axis, at which it is looked for liquid.
constexpr int samples = 21;

/// A bubble and where the file describes it.
struct Ball {
  std::string path;
  SphereShape shape;
};

bool skips(int d, Geometry geometry) { return d == 1 && geometry != Geometry::cartesian; }

/// Notes a middle that lies off the axis or beyond the grid.
void check_center(const CaseConfig& config, const Vec<3>& center, const std::string& path, Reading& reading) {
  const Extent domain = domain_of(config.grid);
  const Geometry geometry = geometry_of(config.grid);
  const char* names[] = {"x", "y", "z"};
  if (geometry == Geometry::axisymmetric && center[0] != 0) {
    reading.problem(path + ".center",
                    "must lie on the axis, x = 0, in axisymmetric cases, not at x = " + shortest(center[0]));
    return;
  }
  for (int d = 0; d < 3; ++d) {
    const double slack = rounding * (domain.high[d] - domain.low[d]);
    if (skips(d, geometry) || (center[d] >= domain.low[d] - slack && center[d] <= domain.high[d] + slack)) continue;
    reading.problem(path + ".center", std::string("must lie within the grid, ") + names[d] + " from " +
                                          shortest(domain.low[d]) + " to " + shortest(domain.high[d]) + ", not at " +
                                          names[d] + " = " + shortest(center[d]));
  }
}

/// Notes planes of symmetry that cut a ball off its middle: the ball and its mirror image would overlap.
void check_mirrors(const CaseConfig& config, const Ball& ball, Reading& reading) {
  const Extent domain = domain_of(config.grid);
  const Boundaries& b = config.boundaries;
  const std::optional<SideConfig> sides[3][2] = {{b.x_min, b.x_max}, {b.y_min, b.y_max}, {b.z_min, b.z_max}};
  const char* names[] = {"x", "y", "z"};
  for (int d = 0; d < 3; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (!sides[d][s] || sides[d][s]->kind != SideKind::symmetry) continue;
      const double plane = s == 0 ? domain.low[d] : domain.high[d];
      const double distance = std::abs(ball.shape.center[d] - plane);
      if (distance <= rounding * (domain.high[d] - domain.low[d])) continue;
      if (distance >= (1 + touching) * ball.shape.radius) continue;
      reading.problem(ball.path + ".center", std::string("must lie on the plane of symmetry ") + names[d] + " = " +
                                                 shortest(plane) + ", or at least the radius " +
                                                 shortest(ball.shape.radius) + " away from it");
    }
  }
}

/// Whether a ball has points inside the grid that no fill covers.
bool outside_liquid(const CaseConfig& config, const SphereShape& ball) {
  const Extent domain = domain_of(config.grid);
  const Geometry geometry = geometry_of(config.grid);
  const bool plane = geometry != Geometry::cartesian;
  const auto uncovered = [&](const Vec<3>& point) {
    for (int d = 0; d < 3; ++d) {
      if (!skips(d, geometry) && !(point[d] > domain.low[d] && point[d] < domain.high[d])) return false;
    }
    return std::none_of(config.initial.begin(), config.initial.end(),
                        [&](const InitialFill& fill) { return contains(fill.shape, point, geometry); });
  };
  const auto across = [&](int d, int number) {
    return ball.center[d] + ball.radius * ((2 * number + 1.03) / samples - 1);
  };
  for (const double pole : {-1 + touching, 1 - touching}) {
    // A little off the axis, on which shapes may end.
    const Vec<3> point{
        {across(0, samples / 2), plane ? 0.5 : across(1, samples / 2), ball.center[2] + pole * ball.radius}};
    if (uncovered(point)) return true;
  }
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < (plane ? 1 : samples); ++j) {
      for (int k = 0; k < samples; ++k) {
        const Vec<3> point{{across(0, i), plane ? 0.5 : across(1, j), across(2, k)}};
        double square = 0;
        for (int d = 0; d < 3; ++d) {
          if (!skips(d, geometry)) square += (point[d] - ball.center[d]) * (point[d] - ball.center[d]);
        }
        if (square <= ball.radius * ball.radius && uncovered(point)) return true;
      }
    }
  }
  return false;
}

/// The first bubble of a charge, if that can be told; notes why not.
std::optional<SphereShape> check_charge(const CaseConfig& config, const InitialCharge& charge, const std::string& path,
                                        Reading& reading) {
  const bool planar = geometry_of(config.grid) == Geometry::planar;
  if (planar && !charge.thickness) {
    reading.problem(path + ".thickness",
                    "is required but missing: in planar cases, extent across the plane over which the mass is spread");
  }
  if (!planar && charge.thickness) {
    reading.problem(path + ".thickness", "is for planar cases only: this charge is a ball");
  }
  if (!reading.clean(path) || !reading.clean("species") || !reading.clean("gravity") ||
      !reading.clean("ambient_pressure") || !reading.clean("boundaries")) {
    return std::nullopt;
  }
  try {
    return SphereShape{charge.center, place_charge(config, charge).bubble.minimum_radius};
  } catch (const InputError& error) {
    reading.problem(path, error.what());
    return std::nullopt;
  }
}

/// Notes grids around the bubbles that no machine could hold.
void check_regrid(const CaseConfig& config, const std::vector<Ball>& balls, Reading& reading) {
  if (!config.regrid || balls.empty() || !reading.clean("regrid")) return;
  const auto smallest = std::min_element(balls.begin(), balls.end(),
                                         [](const Ball& a, const Ball& b) { return a.shape.radius < b.shape.radius; });
  const double width = smallest->shape.radius / config.regrid->bubble_cells;
  const Extent domain = domain_of(config.grid);
  const Geometry geometry = geometry_of(config.grid);
  for (int d = 0; d < 3; ++d) {
    if (skips(d, geometry) || (domain.high[d] - domain.low[d]) / width <= most_widths) continue;
    reading.problem("regrid.bubble_cells", "asks for cells of " + shortest(width) + ", a part of the radius " +
                                               shortest(smallest->shape.radius) + " of " + smallest->path +
                                               ": less than a millionth of the grid's length");
    return;
  }
  // Only where all bubbles are known.
  if (balls.size() == config.bubbles.size() + config.charges.size() && first_grid_cells(config) > most_cells) {
    reading.problem("regrid.bubble_cells", "asks for about " + shortest(std::round(first_grid_cells(config))) +
                                               " cells; at most " + shortest(most_cells));
  }
}

/// The bubbles, and the first bubbles of charges, whose middles and sizes are in order.
std::vector<Ball> find_balls(const CaseConfig& config, Reading& reading) {
  std::vector<Ball> balls;
  for (std::size_t i = 0; i < config.bubbles.size(); ++i) {
    const InitialBubble& bubble = config.bubbles[i];
    const std::string path = child_path("bubbles", i);
    if (!reading.clean(path)) continue;
    check_center(config, bubble.center, path, reading);
    if (reading.clean(path)) balls.push_back({path, {bubble.center, bubble.radius}});
  }
  for (std::size_t i = 0; i < config.charges.size(); ++i) {
    const std::string path = child_path("charges", i);
    if (!reading.clean(path)) continue;
    check_center(config, config.charges[i].center, path, reading);
    if (const auto ball = check_charge(config, config.charges[i], path, reading)) balls.push_back({path, *ball});
  }
  return balls;
}

}  // namespace

void check_bubbles(const CaseConfig& config, Reading& reading) {
  if (config.units == UnitSystem::none && !config.charges.empty()) {
    reading.problem("charges",
                    "need units: SI, as the constants of explosives are in feet, pounds and feet of water; "
                    "give nondimensional cases `bubbles`");
    return;
  }
  if (!reading.clean("grid") || !reading.clean("initial") || config.grid.x.empty() || config.grid.z.empty()) return;
  const Geometry geometry = geometry_of(config.grid);
  const std::vector<Ball> balls = find_balls(config, reading);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Ball& ball = balls[i];
    // A bubble must not touch the side of the domain either.
    check_inside(config, SphereShape{ball.shape.center, (1 + touching) * ball.shape.radius}, ball.path, reading);
    check_mirrors(config, ball, reading);
    if (!reading.clean(ball.path)) continue;
    if (outside_liquid(config, ball.shape)) {
      reading.problem(ball.path, "must lie in liquid, but reaches beyond the initial fills");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!overlap(ball.shape, balls[j].shape, domain_of(config.grid), geometry)) continue;
      reading.problem(ball.path,
                      "overlaps " + balls[j].path + " (" + to_string(reading.nearest(balls[j].path).place) + ")");
    }
  }
  check_regrid(config, balls, reading);
}

}  // namespace quicksand
