#include "app/shape_integrals.hpp"

#include <cmath>

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
