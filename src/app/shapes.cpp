#include "app/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/shape_integrals.hpp"

namespace quicksand {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double overlap_1d(double a0, double a1, double b0, double b1) {
  return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

/// Integral over [low, high] of 1, or of r.
double radial_length(double low, double high, Geometry geometry) {
  if (high <= low) return 0;
  return geometry == Geometry::axisymmetric ? (high - low) * (high + low) / 2 : high - low;
}

/// Height of a wave's surface at the horizontal position x (or r).
double surface(const WaveShape& wave, double x, Geometry geometry) {
  const double kx = wave.wavenumber * x;
  return wave.level +
         wave.amplitude * (geometry == Geometry::axisymmetric ? std::cyl_bessel_j(0, std::abs(kx)) : std::cos(kx));
}

/// Weighted measure of the box.
double measure(const Extent& box, Geometry geometry) {
  return radial_length(box.low[0], box.high[0], geometry) * (box.high[1] - box.low[1]) * (box.high[2] - box.low[2]);
}

/// Distance of the origin to the farthest corner of a box.
double farthest_corner(const Extent& box) {
  const auto far = [&](int d) { return std::max(std::abs(box.low[d]), std::abs(box.high[d])); };
  return std::hypot(far(0), far(1), far(2));
}

/// Distance of the origin to the nearest point of a box.
double nearest_point(const Extent& box) {
  const auto near = [&](int d) { return std::max({box.low[d], -box.high[d], 0.0}); };
  return std::hypot(near(0), near(1), near(2));
}

/// Whether a box and the bounds of a shape share no volume, in the axes that exist.
bool apart(const Extent& box, const Extent& shape, Geometry geometry) {
  for (int d = 0; d < 3; ++d) {
    if (d == 1 && geometry != Geometry::cartesian) continue;
    if (box.high[d] <= shape.low[d] || box.low[d] >= shape.high[d]) return true;
  }
  return false;
}

/// The box's rectangle in (x, z).
Rectangle section(const Extent& box) { return {box.low[0], box.high[0], box.low[2], box.high[2]}; }

/// Weighted measure of the part of a box that a shape fills; one overload per shape.
double filled(const BoxShape& shape, const Extent& box, Geometry geometry) {
  const double x = radial_length(std::max(box.low[0], shape.from[0]), std::min(box.high[0], shape.to[0]), geometry);
  const double y = geometry == Geometry::cartesian ? overlap_1d(box.low[1], box.high[1], shape.from[1], shape.to[1])
                                                   : box.high[1] - box.low[1];
  return x * y * overlap_1d(box.low[2], box.high[2], shape.from[2], shape.to[2]);
}

double filled(const LayerShape& shape, const Extent& box, Geometry geometry) {
  Extent part = box;
  part.low[2] = std::max(box.low[2], shape.bottom);
  part.high[2] = std::max(part.low[2], std::min(box.high[2], shape.top));
  return measure(part, geometry);
}

double filled(const CylinderShape& shape, const Extent& box, Geometry geometry) {
  const double height = overlap_1d(box.low[2], box.high[2], shape.center[2], shape.center[2] + shape.height);
  if (height == 0) return 0;
  if (geometry == Geometry::cartesian) {
    const Rectangle base{box.low[0] - shape.center[0], box.high[0] - shape.center[0], box.low[1] - shape.center[1],
                         box.high[1] - shape.center[1]};
    return height * disc_area(shape.radius, base);
  }
  const double low = std::max(box.low[0], shape.center[0] - shape.radius);
  const double high = std::min(box.high[0], shape.center[0] + shape.radius);
  return height * radial_length(low, high, geometry) * (box.high[1] - box.low[1]);
}

double filled(const SphereShape& shape, const Extent& box, Geometry geometry) {
  Extent centred = box;
  for (int d = 0; d < 3; ++d) {
    centred.low[d] -= shape.center[d];
    centred.high[d] -= shape.center[d];
  }
  if (geometry == Geometry::axisymmetric) return ball_per_radian(shape.radius, section(centred));
  if (geometry == Geometry::planar) return disc_area(shape.radius, section(centred));
  if (farthest_corner(centred) <= shape.radius) return measure(box, geometry);
  if (nearest_point(centred) >= shape.radius) return 0;
  return ball_volume(shape.radius, centred);
}

double filled(const HalfSpaceShape& shape, const Extent& box, Geometry geometry) {
  const Rectangle r = section(box);
  const Polygon rectangle = corners(r);
  const bool radial = geometry == Geometry::axisymmetric;
  const Vec<3>& n = shape.normal;
  const auto area_at = [&](double y) {
    // n_x x + n_z z <= offset
    const double along_y = geometry == Geometry::cartesian ? n[1] * (shape.point[1] - y) : 0;
    const double offset = n[0] * shape.point[0] + n[2] * shape.point[2] + along_y;
    return weighted_area(clip(rectangle, n[0], n[2], offset), radial);
  };
  if (geometry == Geometry::cartesian) {
    // Most cells do not meet the plane.
    double nearest = 0;
    double farthest = 0;
    for (int d = 0; d < 3; ++d) {
      const double ends[] = {n[d] * (box.low[d] - shape.point[d]), n[d] * (box.high[d] - shape.point[d])};
      nearest += std::min(ends[0], ends[1]);
      farthest += std::max(ends[0], ends[1]);
    }
    if (nearest >= 0) return 0;
    if (farthest <= 0) return measure(box, geometry);
  }
  std::vector<double> breaks;
  if (geometry == Geometry::cartesian && n[1] != 0) {
    for (const PolygonPoint& p : rectangle) {
      breaks.push_back(shape.point[1] - (n[0] * (p.x - shape.point[0]) + n[2] * (p.z - shape.point[2])) / n[1]);
    }
  }
  return integrate_between(box.low[1], box.high[1], breaks, 1, area_at);
}

double filled(const PolygonShape& shape, const Extent& box, Geometry geometry) {
  const Polygon inside = clip(shape.points, section(box));
  const double area = weighted_area(inside, geometry == Geometry::axisymmetric);
  return std::abs(area) * (box.high[1] - box.low[1]);
}

/// Waves whose phase changes more than this in a cell are not resolved at all.
constexpr double most_phase = 50;

/// Horizontal positions between which the part of a wave within a box is smooth: its crests, troughs, and where it
/// passes the bottom and the top of the box.
std::vector<double> wave_breaks(const WaveShape& wave, const Extent& box, Geometry geometry) {
  const double low = box.low[0];
  const double high = box.high[0];
  std::vector<double> turns{low};
  const auto slope = [&](double x) {
    const double kx = wave.wavenumber * x;
    return geometry == Geometry::axisymmetric ? std::cyl_bessel_j(1, std::abs(kx)) : std::sin(kx);
  };
  const int parts = 1 + static_cast<int>(wave.wavenumber * (high - low));  // of less than a third of a half wave
  for (int k = 0; k < parts; ++k) {
    append_root(low + (high - low) * k / parts, low + (high - low) * (k + 1) / parts, turns, slope);
  }
  turns.push_back(high);
  std::vector<double> breaks = turns;
  for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
    for (const double z : {box.low[2], box.high[2]}) {
      append_root(turns[i], turns[i + 1], breaks, [&](double x) { return surface(wave, x, geometry) - z; });
    }
  }
  return breaks;
}

double filled(const WaveShape& shape, const Extent& box, Geometry geometry) {
  const double trough = shape.level - std::abs(shape.amplitude);
  const double crest = shape.level + std::abs(shape.amplitude);
  const bool below = shape.bottom.has_value();
  // Most cells do not meet the surface.
  const double bottom = below ? *shape.bottom : crest;
  const double top = below ? trough : *shape.top;
  if (box.high[2] <= trough || box.low[2] >= crest) return filled(LayerShape{bottom, top}, box, geometry);
  const auto column = [&](double x) {
    const double z = surface(shape, x, geometry);
    const double height = overlap_1d(box.low[2], box.high[2], below ? *shape.bottom : z, below ? z : *shape.top);
    return height * (geometry == Geometry::axisymmetric ? x : 1.0);
  };
  const bool resolved = shape.wavenumber * (box.high[0] - box.low[0]) < most_phase;
  const double integral = resolved
                              ? integrate_between(box.low[0], box.high[0], wave_breaks(shape, box, geometry), 4, column)
                              : integrate_between(box.low[0], box.high[0], {}, 64, column);
  return integral * (box.high[1] - box.low[1]);
}

bool inside(const BoxShape& s, const Vec<3>& p, Geometry geometry) {
  const auto between = [&](int d) { return s.from[d] < p[d] && p[d] < s.to[d]; };
  return between(0) && between(2) && (geometry != Geometry::cartesian || between(1));
}

bool inside(const LayerShape& s, const Vec<3>& p, Geometry) { return s.bottom < p[2] && p[2] < s.top; }

double horizontal_distance(const Vec<3>& a, const Vec<3>& b, Geometry geometry) {
  return std::hypot(a[0] - b[0], geometry == Geometry::cartesian ? a[1] - b[1] : 0);
}

bool inside(const CylinderShape& s, const Vec<3>& p, Geometry geometry) {
  return horizontal_distance(p, s.center, geometry) < s.radius && s.center[2] < p[2] && p[2] < s.center[2] + s.height;
}

bool inside(const SphereShape& s, const Vec<3>& p, Geometry geometry) {
  return std::hypot(horizontal_distance(p, s.center, geometry), p[2] - s.center[2]) < s.radius;
}

bool inside(const HalfSpaceShape& s, const Vec<3>& p, Geometry geometry) {
  double distance = 0;
  for (int d = 0; d < 3; ++d) {
    if (d != 1 || geometry == Geometry::cartesian) distance += s.normal[d] * (p[d] - s.point[d]);
  }
  return distance < 0;
}

bool inside(const PolygonShape& s, const Vec<3>& p, Geometry) {
  bool in = false;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const PolygonPoint& a = s.points[i];
    const PolygonPoint& b = s.points[(i + 1) % s.points.size()];
    if ((a.z > p[2]) != (b.z > p[2]) && p[0] < a.x + (b.x - a.x) * (p[2] - a.z) / (b.z - a.z)) in = !in;
  }
  return in;
}

bool inside(const WaveShape& s, const Vec<3>& p, Geometry geometry) {
  const double z = surface(s, p[0], geometry);
  return s.bottom ? *s.bottom < p[2] && p[2] < z : z < p[2] && p[2] < *s.top;
}

constexpr Extent everywhere{Vec<3>{{-infinity, -infinity, -infinity}}, Vec<3>{{infinity, infinity, infinity}}};

Extent bounds_of(const BoxShape& s, Geometry) { return {s.from, s.to}; }

Extent bounds_of(const LayerShape& s, Geometry) {
  Extent e = everywhere;
  e.low[2] = s.bottom;
  e.high[2] = s.top;
  return e;
}

Extent bounds_of(const CylinderShape& s, Geometry) {
  const Vec<3>& c = s.center;
  return {Vec<3>{{c[0] - s.radius, c[1] - s.radius, c[2]}},
          Vec<3>{{c[0] + s.radius, c[1] + s.radius, c[2] + s.height}}};
}

Extent bounds_of(const SphereShape& s, Geometry) {
  Extent e;
  for (int d = 0; d < 3; ++d) {
    e.low[d] = s.center[d] - s.radius;
    e.high[d] = s.center[d] + s.radius;
  }
  return e;
}

/// Bounded only where the plane is normal to an axis.
Extent bounds_of(const HalfSpaceShape& s, Geometry geometry) {
  Extent e = everywhere;
  for (int d = 0; d < 3; ++d) {
    bool normal_to_axis = s.normal[d] != 0;
    for (int other = 0; other < 3; ++other) {
      if (other == 1 && geometry != Geometry::cartesian) continue;
      if (other != d && s.normal[other] != 0) normal_to_axis = false;
    }
    if (normal_to_axis) (s.normal[d] > 0 ? e.high : e.low)[d] = s.point[d];
  }
  return e;
}

Extent bounds_of(const PolygonShape& s, Geometry) {
  Extent e{Vec<3>{{infinity, -infinity, infinity}}, Vec<3>{{-infinity, infinity, -infinity}}};
  for (const PolygonPoint& p : s.points) {
    e.low[0] = std::min(e.low[0], p.x);
    e.high[0] = std::max(e.high[0], p.x);
    e.low[2] = std::min(e.low[2], p.z);
    e.high[2] = std::max(e.high[2], p.z);
  }
  return e;
}

Extent bounds_of(const WaveShape& s, Geometry) {
  Extent e = everywhere;
  e.low[2] = s.bottom.value_or(s.level - std::abs(s.amplitude));
  e.high[2] = s.top.value_or(s.level + std::abs(s.amplitude));
  return e;
}

}  // namespace

double fraction(const Shape& shape, const Extent& box, Geometry geometry) {
  if (apart(box, bounds(shape, geometry), geometry)) return 0;
  const double part = std::visit([&](const auto& s) { return filled(s, box, geometry); }, shape);
  const double result = part / measure(box, geometry);
  // Rounding must not leave 1 - 1e-16 in a full cell nor 1e-16 in an empty one.
  if (result > 1 - 1e-12) return 1;
  return result < 1e-12 ? 0 : result;
}

template <int Dim>
double fraction(const Shape& shape, const Grid<Dim>& grid, const Index<Dim>& i) {
  Extent box{Vec<3>{{0, 0, 0}}, Vec<3>{{0, 1, 0}}};
  for (int d = 0; d < Dim; ++d) {
    const int axis = d == Dim - 1 ? 2 : d;
    box.low[axis] = grid.face_position(d, i[d]);
    box.high[axis] = grid.face_position(d, i[d] + 1);
  }
  return fraction(shape, box, grid.geometry());
}

bool contains(const Shape& shape, const Vec<3>& point, Geometry geometry) {
  return std::visit([&](const auto& s) { return inside(s, point, geometry); }, shape);
}

Extent bounds(const Shape& shape, Geometry geometry) {
  Extent extent = std::visit([&](const auto& s) { return bounds_of(s, geometry); }, shape);
  if (geometry == Geometry::axisymmetric) extent.low[0] = std::max(extent.low[0], 0.0);
  return extent;
}

bool overlap(const Shape& a, const Shape& b, const Extent& domain, Geometry geometry) {
  const Extent of_a = bounds(a, geometry);
  const Extent of_b = bounds(b, geometry);
  const bool space = geometry == Geometry::cartesian;
  const int points = space ? 61 : 251;
  Extent common;
  for (int d = 0; d < 3; ++d) {
    common.low[d] = std::max({of_a.low[d], of_b.low[d], domain.low[d]});
    common.high[d] = std::min({of_a.high[d], of_b.high[d], domain.high[d]});
    // Surfaces that touch, up to rounding, do not overlap.
    if ((space || d != 1) && common.high[d] - common.low[d] <= 1e-9 * (domain.high[d] - domain.low[d])) return false;
  }
  // Off the middle, so that no sample lies on a plane that shapes are likely to share.
  const auto sample = [&](int d, int k) {
    return common.low[d] + (common.high[d] - common.low[d]) * (k + 0.5 + 0.0713) / points;
  };
  for (int k = 0; k < points; ++k) {
    for (int j = 0; j < (space ? points : 1); ++j) {
      for (int i = 0; i < points; ++i) {
        const Vec<3> p{{sample(0, i), space ? sample(1, j) : 0, sample(2, k)}};
        if (contains(a, p, geometry) && contains(b, p, geometry)) return true;
      }
    }
  }
  return false;
}

template double fraction<2>(const Shape&, const Grid<2>&, const Index<2>&);
template double fraction<3>(const Shape&, const Grid<3>&, const Index<3>&);

}  // namespace quicksand
