#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/case_config.hpp"
#include "core/config_node.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Largest ratio of neighbouring widths in a smooth segment.
constexpr double largest_ratio = 2.0;

/// 1 + q + ... + q^(n-1)
double geometric_sum(double q, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum = 1 + q * sum;
  return sum;
}

/// Ratio q of n widths that begin with `first` and add up to `length`.
double find_ratio(double first, double length, int n, const std::string& name) {
  if (std::abs(length - n * first) <= 1e-12 * length) return 1;
  double low = 1 / largest_ratio;
  double high = largest_ratio;
  const double target = length / first;
  if (geometric_sum(low, n) > target || geometric_sum(high, n) < target) {
    throw InputError(name + ": " + std::to_string(n) + " cells that begin with the neighbour's width " +
                     shortest(first) + " can't fill the length " + shortest(length) +
                     " with a ratio of neighbouring widths between 1/2 and 2; use " +
                     (geometric_sum(low, n) > target ? "fewer" : "more") + " cells");
  }
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (geometric_sum(middle, n) < target ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// A segment with both ends known.
struct Span {
  double from;
  double to;
  int cells;
  bool smooth;
  double uniform_width() const { return (to - from) / cells; }
};

std::vector<Span> join_segments(const std::vector<AxisSegment>& segments) {
  std::vector<Span> spans;
  for (const AxisSegment& segment : segments) {
    const double before = spans.empty() ? 0 : spans.back().to;
    spans.push_back({segment.from.value_or(before), segment.to, segment.cells, segment.stretch == Stretch::smooth});
    // Ends that differ by rounding are one.
    if (spans.size() > 1) spans.back().from = before;
  }
  return spans;
}

/// Widths of a segment's cells, from low to high.
std::vector<double> widths_of(const std::vector<Span>& spans, std::size_t i) {
  const Span& span = spans[i];
  std::vector<double> widths(static_cast<std::size_t>(span.cells), span.uniform_width());
  if (!span.smooth) return widths;
  const std::string name = "segment " + std::to_string(i + 1);
  const bool before = i > 0 && !spans[i - 1].smooth;
  const bool after = i + 1 < spans.size() && !spans[i + 1].smooth;
  if (before == after) {
    throw InputError(name +
                     " is smooth and needs exactly one uniform segment beside it, whose width it continues, not " +
                     (before ? "two" : "none"));
  }
  const double first = spans[before ? i - 1 : i + 1].uniform_width();
  const double ratio = find_ratio(first, span.to - span.from, span.cells, name);
  widths.front() = first;
  for (std::size_t k = 1; k < widths.size(); ++k) widths[k] = widths[k - 1] * ratio;
  if (after) std::reverse(widths.begin(), widths.end());
  return widths;
}

}  // namespace

Geometry geometry_of(const GridConfig& config) { return config.dimension == 3 ? Geometry::cartesian : config.geometry; }

std::vector<double> make_faces(const std::vector<AxisSegment>& segments) {
  const std::vector<Span> spans = join_segments(segments);
  std::vector<double> faces{spans.front().from};
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const Span& span = spans[i];
    double x = span.from;
    int k = 0;
    for (const double width : widths_of(spans, i)) {
      ++k;
      x = span.smooth ? x + width : span.from + (span.to - span.from) * k / span.cells;
      faces.push_back(k == span.cells ? span.to : x);
    }
  }
  return faces;
}

std::vector<long> axis_cells(const GridConfig& config) {
  std::vector<long> cells;
  for (const auto* axis : {&config.x, &config.y, &config.z}) {
    if (axis->empty()) continue;
    cells.push_back(std::accumulate(axis->begin(), axis->end(), 0L,
                                    [](long n, const AxisSegment& segment) { return n + segment.cells; }));
  }
  return cells;
}

double count_cells(const GridConfig& config) {
  double cells = 1;
  for (const long n : axis_cells(config)) cells *= static_cast<double>(n);
  return cells;
}

Extent domain_of(const GridConfig& config) {
  const auto low = [](const std::vector<AxisSegment>& axis) { return axis.front().from.value_or(0); };
  const auto high = [](const std::vector<AxisSegment>& axis) { return axis.back().to; };
  Extent domain{Vec<3>{{low(config.x), 0, low(config.z)}}, Vec<3>{{high(config.x), 1, high(config.z)}}};
  if (config.dimension == 3) {
    domain.low[1] = low(config.y);
    domain.high[1] = high(config.y);
  }
  return domain;
}

GridConfig grid_of(const CaseConfig& config, const StageConfig& stage) {
  return {config.grid.dimension, config.grid.geometry, stage.grid.x, stage.grid.y, stage.grid.z};
}

template <int Dim>
Grid<Dim> make_grid(const GridConfig& config) {
  std::array<std::vector<double>, Dim> faces;
  faces.front() = make_faces(config.x);
  if (Dim == 3) faces[1] = make_faces(config.y);
  faces.back() = make_faces(config.z);
  return Grid<Dim>(std::move(faces), geometry_of(config));
}

template <int Dim>
Sides<Dim> make_sides(const CaseConfig& config) {
  const Boundaries& b = config.boundaries;
  const auto side = [&](const std::optional<SideConfig>& given) {
    const SideConfig& s = given.value();
    const bool inflow = s.kind == SideKind::inflow;
    Side result{s.kind, s.pressure, std::nullopt, {}, s.inflow.profile};
    const std::optional<std::string>& outside = inflow ? s.inflow.fill : s.outside;
    if (outside) result.outside = species_number(config, *outside);
    const Vec<Dim> along_axes = in_axes<Dim>(inflow ? s.inflow.velocity : s.velocity);
    for (int d = 0; d < Dim; ++d) result.velocity[d] = along_axes[d];
    return result;
  };
  Sides<Dim> sides;
  sides.at(0, 0) = side(b.x_min);
  sides.at(0, 1) = side(b.x_max);
  if constexpr (Dim == 3) {
    sides.at(1, 0) = side(b.y_min);
    sides.at(1, 1) = side(b.y_max);
  }
  sides.at(Dim - 1, 0) = side(b.z_min);
  sides.at(Dim - 1, 1) = side(b.z_max);
  return sides;
}

template Grid<2> make_grid<2>(const GridConfig&);
template Grid<3> make_grid<3>(const GridConfig&);
template Sides<2> make_sides<2>(const CaseConfig&);
template Sides<3> make_sides<3>(const CaseConfig&);

}  // namespace quicksand
