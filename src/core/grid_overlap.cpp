#include "core/grid_overlap.hpp"

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "core/text_output.hpp"

namespace quicksand {

namespace {

/// Faces closer than this, relative to the cells beside them, are one.
constexpr double face_slack = 1e-12;

}  // namespace

AxisOverlap::AxisOverlap(const std::vector<double>& source, std::vector<double> target, bool radial) {
  const double slack = face_slack * (source.back() - source.front());
  if (std::abs(source.front() - target.front()) > slack || std::abs(source.back() - target.back()) > slack) {
    throw InputError("the grids do not fill the same domain: one axis goes from " + number_text(source.front()) +
                     " to " + number_text(source.back()) + ", the other from " + number_text(target.front()) + " to " +
                     number_text(target.back()));
  }
  target.front() = source.front();
  target.back() = source.back();
  first_of_source_.push_back(0);
  first_of_target_.push_back(0);
  std::size_t i = 0;
  std::size_t j = 0;
  double low = source.front();
  while (i + 1 < source.size() && j + 1 < target.size()) {
    const double width = source[i + 1] - source[i];
    const double gap = source[i + 1] - target[j + 1];
    const bool together = std::abs(gap) <= face_slack * std::min(width, target[j + 1] - target[j]) ||
                          (i + 2 == source.size() && j + 2 == target.size());
    const bool source_ends = together || gap < 0;
    const double high = source_ends ? source[i + 1] : target[j + 1];
    AxisPart part{static_cast<int>(i), static_cast<int>(j)};
    part.low = std::max((low - source[i]) / width, 0.0);
    part.high = source_ends ? 1.0 : (high - source[i]) / width;
    const double length = high - low;
    const double middle = 0.5 * (low + high);
    part.weight = radial ? middle * length : length;
    part.centre = radial ? middle + length * length / (12 * middle) : middle;
    parts_.push_back(part);
    if (source_ends) {
      ++i;
      first_of_source_.push_back(parts_.size());
    }
    if (together || gap > 0) {
      ++j;
      first_of_target_.push_back(parts_.size());
    }
    low = high;
  }
}

template <int Dim>
GridOverlap<Dim>::GridOverlap(const Grid<Dim>& source, const Grid<Dim>& target) : source_(source), target_(target) {
  if (source.geometry() != target.geometry()) throw InputError("the grids differ in geometry");
  for (int d = 0; d < Dim; ++d) {
    axes_[at(d)] = AxisOverlap(source.global_faces(d), target.global_faces(d), source.axisymmetric() && d == 0);
  }
}

template class GridOverlap<2>;
template class GridOverlap<3>;

}  // namespace quicksand
