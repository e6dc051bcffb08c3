#pragma once
/// \file
/// Axes refined around an interval.
#include <vector>

namespace quicksand {

/// Where an axis has small cells.
struct RefinedInterval {
  double low = 0;
  double high = 0;
  double width = 0;   ///< of the cells in it, at most
  double growth = 0;  ///< increase of the width per length, away from it
};

/// Faces of an axis with the ends of another, whose cells are at most as wide as its cells there in the mean, of the
/// interval's width inside the interval, and grow steadily to either side of it.
std::vector<double> adapted_faces(const std::vector<double>& base, const RefinedInterval& fine);

}  // namespace quicksand
