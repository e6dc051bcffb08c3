#include "app/shape_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace quicksand {

namespace {

/// Lengths below this part of the domain's size are rounding.
constexpr double rounding = 1e-9;

/// What is wrong with a single shape, if anything: a key below the shape and a message.
struct Flaw {
  std::string key;
  std::string message;
};

std::vector<Flaw> flaws(const BoxShape& box, Geometry geometry) {
  std::vector<Flaw> found;
  const char* names[] = {"x", "y", "z"};
  for (int d = 0; d < 3; ++d) {
    if (d == 1 && geometry != Geometry::cartesian) continue;
    if (!(box.from[d] < box.to[d])) {
      found.push_back({"box.to", std::string("must be greater than from in ") + names[d] + ": " + shortest(box.to[d]) +
                                     " is not greater than " + shortest(box.from[d])});
    }
  }
  return found;
}

std::vector<Flaw> flaws(const LayerShape& layer, Geometry) {
  if (layer.bottom < layer.top) return {};
  return {{"layer.top", "must be greater than bottom = " + shortest(layer.bottom) + ", not " + shortest(layer.top)}};
}

std::vector<Flaw> centred(const std::string& name, const Vec<3>& center, Geometry geometry) {
  if (geometry != Geometry::axisymmetric || center[0] == 0) return {};
  return {{name + ".center", "must lie on the axis, x = 0, in axisymmetric cases, not at x = " + shortest(center[0])}};
}

std::vector<Flaw> flaws(const CylinderShape& cylinder, Geometry geometry) {
  return centred("cylinder", cylinder.center, geometry);
}

std::vector<Flaw> flaws(const SphereShape& sphere, Geometry geometry) {
  return centred("sphere", sphere.center, geometry);
}

std::vector<Flaw> flaws(const HalfSpaceShape& half, Geometry geometry) {
  const Vec<3>& n = half.normal;
  if (n[0] != 0 || n[2] != 0 || (n[1] != 0 && geometry == Geometry::cartesian)) return {};
  return {{"half_space.normal", "must not be zero"}};
}

double cross(const PolygonPoint& o, const PolygonPoint& a, const PolygonPoint& b) {
  return (a.x - o.x) * (b.z - o.z) - (a.z - o.z) * (b.x - o.x);
}

/// Whether two line segments cross at an inner point of both.
bool segments_cross(const PolygonPoint& a, const PolygonPoint& b, const PolygonPoint& c, const PolygonPoint& d) {
  return cross(a, b, c) * cross(a, b, d) < 0 && cross(c, d, a) * cross(c, d, b) < 0;
}

std::vector<Flaw> flaws(const PolygonShape& polygon, Geometry) {
  const auto& p = polygon.points;
  const std::size_t n = p.size();
  double area = 0;
  double scale = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double part = cross(p[0], p[i], p[(i + 1) % n]);
    area += part;
    scale += std::abs(part);
    for (std::size_t j = i + 2; j < n; ++j) {
      if (segments_cross(p[i], p[i + 1], p[j], p[(j + 1) % n])) {
        return {{"polygon.points", "sides " + std::to_string(i + 1) + " and " + std::to_string(j + 1) + " cross"}};
      }
    }
  }
  if (std::abs(area) <= rounding * scale || area == 0) return {{"polygon.points", "must enclose an area"}};
  return {};
}

std::vector<Flaw> flaws(const WaveShape& wave, Geometry) {
  if (wave.bottom.has_value() == wave.top.has_value()) {
    return {{"wave", "give either bottom, to fill below the wave, or top, to fill above it"}};
  }
  if (wave.bottom && !(*wave.bottom < wave.level - std::abs(wave.amplitude))) {
    return {{"wave.bottom", "must lie below the trough, level - |amplitude|, not at " + shortest(*wave.bottom)}};
  }
  if (wave.top && !(*wave.top > wave.level + std::abs(wave.amplitude))) {
    return {{"wave.top", "must lie above the crest, level + |amplitude|, not at " + shortest(*wave.top)}};
  }
  return {};
}

bool check_shape(const CaseConfig& config, const Shape& shape, const std::string& path, Reading& reading) {
  const Geometry geometry = geometry_of(config.grid);
  const auto found = std::visit([&](const auto& s) { return flaws(s, geometry); }, shape);
  for (const Flaw& flaw : found) reading.problem(path + "." + flaw.key, flaw.message);
  if (found.empty()) check_inside(config, shape, path, reading);
  return found.empty();
}

}  // namespace

void check_inside(const CaseConfig& config, const Shape& shape, const std::string& path, Reading& reading) {
  const Extent domain = domain_of(config.grid);
  const Geometry geometry = geometry_of(config.grid);
  const Extent extent = bounds(shape, geometry);
  const Boundaries& b = config.boundaries;
  const std::optional<SideConfig> sides[3][2] = {{b.x_min, b.x_max}, {b.y_min, b.y_max}, {b.z_min, b.z_max}};
  const char* names[] = {"x", "y", "z"};
  for (int d = 0; d < 3; ++d) {
    if (d == 1 && geometry != Geometry::cartesian) continue;
    for (int s = 0; s < 2; ++s) {
      const double reach = s == 0 ? extent.low[d] : extent.high[d];
      const double end = s == 0 ? domain.low[d] : domain.high[d];
      const double beyond = s == 0 ? end - reach : reach - end;
      const std::optional<SideConfig>& side = sides[d][s];
      const bool mirrored = side && (side->kind == SideKind::axis || side->kind == SideKind::symmetry);
      if (mirrored || !std::isfinite(reach) || beyond <= rounding * (domain.high[d] - domain.low[d])) continue;
      reading.problem(path, std::string("reaches beyond the grid: to ") + names[d] + " = " + shortest(reach) +
                                ", where the grid ends at " + shortest(end));
    }
  }
}

void check_initial(const CaseConfig& config, Reading& reading) {
  std::vector<std::string> names;
  for (const Species& species : config.species) names.push_back(species.name);
  // A species whose name could not be read may be any.
  const bool names_known = !names.empty() && std::find(names.begin(), names.end(), "") == names.end();
  const Geometry geometry = geometry_of(config.grid);
  const bool grid_known = reading.clean("grid") && !config.grid.x.empty() && !config.grid.z.empty();
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < config.initial.size(); ++i) {
    const InitialFill& fill = config.initial[i];
    const std::string path = child_path("initial", i);
    if (names_known && !fill.fill.empty() && std::find(names.begin(), names.end(), fill.fill) == names.end()) {
      reading.problem(path + ".fill", in_quotes(fill.fill) + " is not a species; they are " + join(names) +
                                          suggestion(fill.fill, names));
    }
    if (geometry == Geometry::axisymmetric && reading.clean(path + ".velocity") && fill.velocity[0] != 0) {
      reading.problem(path + ".velocity", "must point along z in axisymmetric cases");
    }
    const std::string shape = path + ".shape";
    if (!grid_known || reading.nearest(shape).path != shape || !reading.clean(shape)) continue;
    if (check_shape(config, fill.shape, shape, reading)) usable.push_back(i);
  }
  if (!grid_known) return;
  const Extent domain = domain_of(config.grid);
  for (const std::size_t i : usable) {
    for (const std::size_t j : usable) {
      if (j >= i || !overlap(config.initial[i].shape, config.initial[j].shape, domain, geometry)) continue;
      const std::string first = child_path("initial", j) + ".shape";
      reading.problem(child_path("initial", i) + ".shape",
                      "overlaps " + first + " (" + to_string(reading.nearest(first).place) + ")");
    }
  }
}

}  // namespace quicksand
