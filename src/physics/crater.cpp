#include "physics/crater.hpp"

#include <algorithm>
#include <numeric>

namespace quicksand {

namespace {

/// What is less deep than this share of the crater's depth does not make it wider.
constexpr double least_depth = 0.1;
/// What is less deep than this share of a cell is no crater with a width.
constexpr double least_cells = 0.01;
/// A bed that has sunk as a whole by less than these shares of a cell and of the depth is still level.
constexpr double level_cells = 0.25;
constexpr double level_depth = 0.05;

/// Where a row of columns crosses the level.
struct Span {
  double low, high;
};

/// Position of column `n` of a profile.
template <int Dim>
Vec<Dim - 1> position(const BedProfile<Dim>& profile, std::size_t n) {
  Vec<Dim - 1> x;
  for (int d = 0; d < Dim - 1; ++d) {
    const std::vector<double>& centre = profile.axes[static_cast<std::size_t>(d)].centre;
    x[d] = centre[n % centre.size()];
    n /= centre.size();
  }
  return x;
}

/// Where the surface crosses the level between column `inside`, below it, and its neighbour `outside`.
double crossing(double x_inside, double inside, double x_outside, double outside, double level) {
  return x_inside + (level - inside) / (outside - inside) * (x_outside - x_inside);
}

/// Outermost crossings of a row; low = high where nothing is deep enough.
/// \param height  of the row's column with a number \param deep  largest height of what counts
template <class Height>
Span span_of(const ProfileAxis& axis, double level, double deep, Height&& height) {
  const std::size_t n = axis.centre.size();
  std::size_t first = 0;
  while (first < n && height(first) > deep) ++first;
  if (first == n) return {axis.low, axis.low};
  std::size_t last = n - 1;
  while (height(last) > deep) --last;
  while (first > 0 && height(first - 1) < level) --first;
  while (last + 1 < n && height(last + 1) < level) ++last;
  const auto edge = [&](std::size_t in, std::size_t out) {
    return crossing(axis.centre[in], height(in), axis.centre[out], height(out), level);
  };
  return {first > 0 ? edge(first, first - 1) : axis.low, last + 1 < n ? edge(last, last + 1) : axis.high};
}

double width_of(const ProfileAxis& axis, const Span& span) {
  if (axis.mirrored_low) return 2 * (span.high - axis.low);
  if (axis.mirrored_high) return 2 * (axis.high - span.low);
  return span.high - span.low;
}

/// Width along d of a surface with these heights: of what the crossings of all rows along d enclose.
template <int Dim>
double width_along(const BedProfile<Dim>& profile, const std::vector<double>& heights, int d, double level,
                   double deep) {
  std::size_t stride = 1;
  for (int e = 0; e < d; ++e) stride *= profile.axes[static_cast<std::size_t>(e)].centre.size();
  const ProfileAxis& axis = profile.axes[static_cast<std::size_t>(d)];
  Span widest{axis.high, axis.low};
  for (std::size_t start = 0; start < heights.size(); ++start) {
    if (start / stride % axis.centre.size() != 0) continue;
    const Span span = span_of(axis, level, deep, [&](std::size_t i) { return heights[start + i * stride]; });
    if (!(span.high > span.low)) continue;
    widest = {std::min(widest.low, span.low), std::max(widest.high, span.high)};
  }
  return width_of(axis, widest);
}

/// What lies between the level and a surface with these heights.
template <int Dim>
Hollow<Dim> measure_hollow(const BedProfile<Dim>& profile, const std::vector<double>& heights, double level) {
  Hollow<Dim> hollow;
  const auto lowest = static_cast<std::size_t>(std::min_element(heights.begin(), heights.end()) - heights.begin());
  if (!(heights[lowest] < level)) return hollow;
  hollow.depth = level - heights[lowest];
  hollow.deepest = position(profile, lowest);
  for (std::size_t n = 0; n < heights.size(); ++n) {
    hollow.volume += profile.area[n] * std::max(level - heights[n], 0.0);
  }
  if (hollow.depth > least_cells * profile.resolution) {
    const double deep = level - least_depth * hollow.depth;
    const double edge = level - std::min(level_cells * profile.resolution, level_depth * hollow.depth);
    for (int d = 0; d < Dim - 1; ++d) hollow.width[d] = width_along(profile, heights, d, edge, deep);
  }
  return hollow;
}

}  // namespace

template <int Dim>
double median_height(const BedProfile<Dim>& profile) {
  const std::vector<double>& z = profile.top;
  std::vector<std::size_t> by_height(z.size());
  std::iota(by_height.begin(), by_height.end(), std::size_t{0});
  std::stable_sort(by_height.begin(), by_height.end(), [&](std::size_t a, std::size_t b) { return z[a] < z[b]; });
  const double whole = std::accumulate(profile.area.begin(), profile.area.end(), 0.0);
  double below = 0;
  for (const std::size_t n : by_height) {
    below += profile.area[n];
    if (below >= whole / 2) return z[n];
  }
  return z[by_height.back()];
}

template <int Dim>
Crater<Dim> measure_crater(const BedProfile<Dim>& profile, double level) {
  const std::vector<double>& top = profile.top;
  Crater<Dim> crater;
  crater.whole = measure_hollow(profile, profile.surface, level);
  crater.open = measure_hollow(profile, top, level);
  const auto highest = static_cast<std::size_t>(std::max_element(top.begin(), top.end()) - top.begin());
  if (!(top[highest] > level)) return crater;
  crater.lip_height = top[highest] - level;
  crater.lip = position(profile, highest);
  for (std::size_t n = 0; n < top.size(); ++n) {
    crater.volume_of_lip += profile.area[n] * std::max(top[n] - level, 0.0);
  }
  return crater;
}

#define QUICKSAND_INSTANTIATE(Dim)                       \
  template double median_height(const BedProfile<Dim>&); \
  template Crater<Dim> measure_crater(const BedProfile<Dim>&, double);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
