#pragma once
/// \file
/// Areas and volumes of shapes cut out of rectangles.
#include <algorithm>
#include <vector>

#include "app/shapes.hpp"

namespace quicksand {

struct Rectangle {
  double x0, x1;
  double y0, y1;
};

using Polygon = std::vector<PolygonPoint>;

/// Area of a rectangle within the disc of a radius about the origin (exact).
double disc_area(double radius, const Rectangle& rectangle);

/// Volume per radian of an (r, z) rectangle within the ball of a radius about the origin (exact).
double ball_per_radian(double radius, const Rectangle& rectangle);

/// Volume of a box within the ball of a radius about the origin (exact, up to rounding of the ball's volume).
double ball_volume(double radius, const Extent& box);

/// Corners of a rectangle in the (x, z) plane, counterclockwise.
Polygon corners(const Rectangle& rectangle);
/// Part of a polygon in nx x + nz z <= offset.
Polygon clip(const Polygon& polygon, double nx, double nz, double offset);
/// Part of a polygon within a rectangle.
Polygon clip(const Polygon& polygon, const Rectangle& rectangle);
/// Integral of 1, or of x where `radial`, over a polygon (exact; negative for clockwise polygons).
double weighted_area(const Polygon& polygon, bool radial);

/// Appends to `roots` where a function that is monotone over [low, high] changes sign, if it does.
template <class F>
void append_root(double low, double high, std::vector<double>& roots, F&& f) {
  constexpr int halvings = 48;
  const bool from_below = f(low) < 0;
  if (from_below == (f(high) < 0)) return;
  for (int k = 0; k < halvings; ++k) {
    const double middle = low + (high - low) / 2;
    ((f(middle) < 0) == from_below ? low : high) = middle;
  }
  roots.push_back(low + (high - low) / 2);
}

/// Integral of f over [low, high] with four Gauss points in each of `parts` equal parts between consecutive breaks.
template <class F>
double integrate_between(double low, double high, std::vector<double> breaks, int parts, F&& f) {
  constexpr double abscissa[] = {0.33998104358485626, 0.86113631159405258};
  constexpr double weight[] = {0.65214515486254614, 0.34785484513745386};
  if (!(high > low)) return 0;
  breaks.push_back(low);
  breaks.push_back(high);
  for (double& x : breaks) x = std::clamp(x, low, high);
  std::sort(breaks.begin(), breaks.end());
  double total = 0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double half = (breaks[i + 1] - breaks[i]) / (2 * parts);
    if (half <= 0) continue;
    for (int k = 0; k < parts; ++k) {
      const double middle = breaks[i] + (2 * k + 1) * half;
      for (int g = 0; g < 2; ++g) {
        total += weight[g] * half * (f(middle - abscissa[g] * half) + f(middle + abscissa[g] * half));
      }
    }
  }
  return total;
}

}  // namespace quicksand
