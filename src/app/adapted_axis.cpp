#include "app/adapted_axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quicksand {

namespace {

/// Samples of the width per cell of the base axis or per fine cell, whichever are more.
constexpr int samples_per_cell = 16;

}  // namespace

std::vector<double> adapted_faces(const std::vector<double>& base, const RefinedInterval& fine) {
  // Places where the width may change its slope, and points between them close enough to integrate 1 / width.
  std::vector<double> ends = base;
  for (const double x : {fine.low, fine.high}) {
    if (x > base.front() && x < base.back()) ends.push_back(x);
  }
  std::sort(ends.begin(), ends.end());
  std::vector<double> place{ends.front()};
  std::vector<double> count{0};  // number of cells from the low end up to there
  std::size_t cell = 0;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    const double length = ends[k] - ends[k - 1];
    if (!(length > 0)) continue;
    while (base[cell + 1] <= ends[k - 1]) ++cell;
    const double widest = base[cell + 1] - base[cell];
    const int samples = samples_per_cell * static_cast<int>(std::ceil(length / std::min(widest, fine.width)));
    for (int i = 0; i < samples; ++i) {
      const double x = ends[k - 1] + length * (i + 0.5) / samples;
      const double distance = std::max({fine.low - x, x - fine.high, 0.0});
      const double width = std::min(widest, fine.width + fine.growth * distance);
      place.push_back(ends[k - 1] + length * (i + 1) / samples);
      count.push_back(count.back() + length / samples / width);
    }
  }
  const double cells = std::ceil(count.back() * (1 - 1e-9));
  std::vector<double> faces{base.front()};
  std::size_t i = 1;
  for (double k = 1; k < cells; ++k) {
    const double wanted = count.back() * k / cells;
    while (count[i] < wanted) ++i;
    faces.push_back(place[i - 1] + (place[i] - place[i - 1]) * (wanted - count[i - 1]) / (count[i] - count[i - 1]));
  }
  faces.push_back(base.back());
  return faces;
}

}  // namespace quicksand
