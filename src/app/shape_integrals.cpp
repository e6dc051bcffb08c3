#include "app/shape_integrals.hpp"

#include <cmath>
#include <numbers>

namespace quicksand {

namespace {

/// Integral of sqrt(R² - x²) from 0 to x, |x| <= R.
double circle_integral(double radius, double x) {
  const double root = std::sqrt(std::max(0.0, (radius - x) * (radius + x)));
  return (x * root + radius * radius * std::atan2(x, root)) / 2;
}

/// Values of x, sorted and within [low, high], at which a circle of a radius passes the given heights.
std::vector<double> crossings(double radius, double low, double high, double height0, double height1) {
  std::vector<double> x{low, high, 0.0};
  for (const double height : {height0, height1}) {
    if (std::abs(height) >= radius) continue;
    const double root = std::sqrt((radius - height) * (radius + height));
    x.push_back(-root);
    x.push_back(root);
  }
  for (double& value : x) value = std::clamp(value, low, high);
  std::sort(x.begin(), x.end());
  return x;
}

/// Volume of the part x, y, z and beyond of a ball about the origin, all three at least 0.
///
/// By the divergence theorem it is a third of the radius times the curved area less the sum of each plane's distance
/// times its area. The curved area follows from the theorem of Gauss and Bonnet: 2 pi less the angles by which its edge
/// turns at its corners, and less the edge's geodesic curvature, which is the angle of each arc times its plane's
/// distance.
double corner_of_ball(double radius, double x, double y, double z) {
  const double square = radius * radius;
  if (x * x + y * y + z * z >= square) return 0;
  const double at[] = {x, y, z};
  // Where the planes of two coordinates cut the surface: the third coordinate there, by the number of the third.
  double edge[3];
  double curved = 2 * std::numbers::pi;
  for (int d = 0; d < 3; ++d) {
    const double a = at[(d + 1) % 3];
    const double b = at[(d + 2) % 3];
    edge[d] = std::sqrt(square - (a * a + b * b));
    curved -= std::atan2(radius * edge[d], -a * b);
  }
  double volume = square * radius * curved;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3;
    const int f = (d + 2) % 3;
    const double arc = std::atan2(edge[f], at[e]) - std::atan2(at[f], edge[e]);
    const double triangles = at[e] * (edge[f] - at[f]) + at[f] * (edge[e] - at[e]);
    const double plane = ((square - at[d] * at[d]) * arc - triangles) / 2;
    volume -= at[d] * (square * arc + plane);
  }
  return volume / 3;
}

/// Volume of a ball about the origin within the box from there to (x, y, z); odd in each.
double box_from_centre(double radius, double x, double y, double z) {
  const double sign = (x < 0 ? -1 : 1) * (y < 0 ? -1 : 1) * (z < 0 ? -1 : 1);
  x = std::abs(x);
  y = std::abs(y);
  z = std::abs(z);
  const auto beyond = [&](double a, double b, double c) { return corner_of_ball(radius, a, b, c); };
  return sign * (beyond(0, 0, 0) - beyond(x, 0, 0) - beyond(0, y, 0) - beyond(0, 0, z) + beyond(x, y, 0) +
                 beyond(x, 0, z) + beyond(0, y, z) - beyond(x, y, z));
}

}  // namespace

double disc_area(double radius, const Rectangle& rectangle) {
  const auto& [x0, x1, y0, y1] = rectangle;
  const double low = std::max(x0, -radius);
  const double high = std::min(x1, radius);
  if (low >= high) return 0;
  const std::vector<double> x = crossings(radius, low, high, y0, y1);
  double area = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    // Between crossings the upper end of the chord is the circle or y1, the lower one the circle or y0.
    const double middle = (x[i] + x[i + 1]) / 2;
    const double root = std::sqrt(std::max(0.0, (radius - middle) * (radius + middle)));
    if (std::min(root, y1) <= std::max(-root, y0)) continue;
    const double width = x[i + 1] - x[i];
    const double arc = circle_integral(radius, x[i + 1]) - circle_integral(radius, x[i]);
    area += (root < y1 ? arc : y1 * width) - (-root > y0 ? -arc : y0 * width);
  }
  return area;
}

double ball_per_radian(double radius, const Rectangle& rectangle) {
  const auto& [r0, r1, z0, z1] = rectangle;
  const double low = std::max(z0, -radius);
  const double high = std::min(z1, radius);
  if (low >= high) return 0;
  const std::vector<double> z = crossings(radius, low, high, r0, r1);
  double volume = 0;
  for (std::size_t i = 0; i + 1 < z.size(); ++i) {
    const double middle = (z[i] + z[i + 1]) / 2;
    const double reach = std::sqrt(std::max(0.0, (radius - middle) * (radius + middle)));
    if (reach <= r0) continue;
    const double height = z[i + 1] - z[i];
    const double cubes = (z[i + 1] * z[i + 1] * z[i + 1] - z[i] * z[i] * z[i]) / 3;
    const double outer = reach >= r1 ? r1 * r1 * height : radius * radius * height - cubes;
    volume += (outer - r0 * r0 * height) / 2;
  }
  return volume;
}

double ball_volume(double radius, const Extent& box) {
  const Vec<3>* ends[] = {&box.low, &box.high};
  double part[2][2][2];
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k) {
        const double at[] = {(*ends[i])[0], (*ends[j])[1], (*ends[k])[2]};
        part[i][j][k] = box_from_centre(radius, at[0], at[1], at[2]);
      }
    }
  }
  // Differences of differences, so that mirror images have the same volume to the last bit.
  const auto along_x = [&](int j, int k) { return part[1][j][k] - part[0][j][k]; };
  const auto along_y = [&](int k) { return along_x(1, k) - along_x(0, k); };
  return along_y(1) - along_y(0);
}

Polygon corners(const Rectangle& r) { return {{r.x0, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}}; }

Polygon clip(const Polygon& polygon, double nx, double nz, double offset) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PolygonPoint& a = polygon[i];
    const PolygonPoint& b = polygon[(i + 1) % polygon.size()];
    const double of_a = nx * a.x + nz * a.z - offset;
    const double of_b = nx * b.x + nz * b.z - offset;
    if (of_a <= 0) result.push_back(a);
    if ((of_a < 0 && of_b > 0) || (of_a > 0 && of_b < 0)) {
      const double t = of_a / (of_a - of_b);
      result.push_back({a.x + t * (b.x - a.x), a.z + t * (b.z - a.z)});
    }
  }
  return result;
}

Polygon clip(const Polygon& polygon, const Rectangle& r) {
  return clip(clip(clip(clip(polygon, -1, 0, -r.x0), 1, 0, r.x1), 0, -1, -r.y0), 0, 1, r.y1);
}

double weighted_area(const Polygon& polygon, bool radial) {
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    // Relative to the first corner in z, against cancellation.
    const PolygonPoint& a = polygon[i];
    const PolygonPoint& b = polygon[(i + 1) % polygon.size()];
    const double z0 = polygon.front().z;
    const double twice = a.x * (b.z - z0) - b.x * (a.z - z0);
    area += radial ? twice * (a.x + b.x) / 6 : twice / 2;
  }
  return area;
}

}  // namespace quicksand
