#pragma once
/// \file
/// Limited slopes of cell averages.
#include <algorithm>
#include <cmath>

#include "core/grid.hpp"

namespace quicksand {

/// The least of three slopes, or 0 where the one-sided ones differ in sign.
inline double limit_mc(double low, double centre, double high) {
  if (low * high <= 0) return 0;
  const double magnitude = std::min({std::abs(low), std::abs(centre), std::abs(high)});
  return low > 0 ? magnitude : -magnitude;
}

/// Limited derivative of q along d in cell c with index i: monotonized central differences (van Leer 1977) on widths
/// that may vary; one ghost layer.
template <int Dim>
double limited_slope(const Grid<Dim>& grid, const CellField& q, Cell c, const Index<Dim>& i, int d) {
  const Step e = grid.step(d);
  const double w = grid.width_1d(d, i[d]);
  const double centre = (q[c + e] - q[c - e]) / grid.spacing_around(d, i[d]);
  return limit_mc(2 * (q[c] - q[c - e]) / w, centre, 2 * (q[c + e] - q[c]) / w);
}

}  // namespace quicksand
