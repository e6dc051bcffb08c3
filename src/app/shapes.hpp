#pragma once
/// \file
/// Shapes that are filled with a species at the start.
///
/// Points are (x, y, z), with z up; in two dimensions y is ignored, and in axisymmetric cases x is the radius. In
/// planar cases a cylinder is the rectangle |x - x_centre| <= radius and a sphere is a disc; in axisymmetric cases both
/// must be centred on the axis, and a box or polygon is the body of revolution of its cross-section.
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/grid.hpp"

namespace quicksand {

/// from <= x <= to in every axis.
struct BoxShape {
  Vec<3> from;
  Vec<3> to;
};

/// bottom <= z <= top.
struct LayerShape {
  double bottom = 0;
  double top = 0;
};

/// Upright circular cylinder; `center` is the middle of its base.
struct CylinderShape {
  Vec<3> center;
  double radius = 0;
  double height = 0;
};

struct SphereShape {
  Vec<3> center;
  double radius = 0;
};

/// (x - point) . normal <= 0: `normal` points out of the filled half.
struct HalfSpaceShape {
  Vec<3> point;
  Vec<3> normal;
};

/// Corner of a polygon.
struct PolygonPoint {
  double x = 0;
  double z = 0;
};

/// Simple polygon in the plane (x, z); in 3-D the prism along y over it.
struct PolygonShape {
  std::vector<PolygonPoint> points;
};

/// Below or above the surface z = level + amplitude cos(wavenumber x), or amplitude J0(wavenumber r) in axisymmetric
/// cases.
struct WaveShape {
  std::optional<double> bottom;  ///< filled from here up to the surface ...
  std::optional<double> top;     ///< ... or from the surface up to here; one of the two is present
  double level = 0;
  double amplitude = 0;
  double wavenumber = 0;
};

using Shape = std::variant<BoxShape, LayerShape, CylinderShape, SphereShape, HalfSpaceShape, PolygonShape, WaveShape>;

/// An axis-aligned box of space, such as a cell or the domain; y is [0, 1] in two dimensions.
struct Extent {
  Vec<3> low;
  Vec<3> high;
};

/// Fraction of a box that a shape fills, weighted with r for `Geometry::axisymmetric`. Exact up to rounding; for
/// balls in 3-D up to rounding of the ball's volume, below 1e-9 of the cell up to 80 cells per radius, for waves to
/// 1e-10.
double fraction(const Shape& shape, const Extent& box, Geometry geometry);

/// Fraction of an owned cell that a shape fills.
template <int Dim>
double fraction(const Shape& shape, const Grid<Dim>& grid, const Index<Dim>& i);

/// Whether a point lies strictly inside a shape.
bool contains(const Shape& shape, const Vec<3>& point, Geometry geometry);

/// Smallest box around a shape, in directions in which it is bounded; infinite in others.
Extent bounds(const Shape& shape, Geometry geometry);

/// Whether two shapes share volume within the domain, found by sampling where their bounds meet.
bool overlap(const Shape& a, const Shape& b, const Extent& domain, Geometry geometry);

}  // namespace quicksand
