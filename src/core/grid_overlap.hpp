#pragma once
/// \file
/// What the cells of two grids of one domain share: the ground of conservative maps from one to the other.
#include <array>
#include <span>
#include <vector>

#include "core/grid.hpp"

namespace quicksand {

/// The part of a source cell that lies in a target cell, along one axis.
struct AxisPart {
  int source = 0;
  int target = 0;
  double low = 0;     ///< ends, in widths of the source cell from its low face
  double high = 1;    ///< \copydoc low
  double weight = 0;  ///< integral of the axis' weight (1, or r) over the part
  double centre = 0;  ///< weighted mean position
};

/// The parts of two axes with the same ends, from low to high.
class AxisOverlap {
 public:
  AxisOverlap() = default;
  /// \param source, target  face coordinates; faces closer than round-off are one
  /// \param radial          whether the weight is the coordinate itself
  /// \throws InputError where the ends of the axes differ
  AxisOverlap(const std::vector<double>& source, std::vector<double> target, bool radial);

  std::span<const AxisPart> of_source(int i) const { return range(first_of_source_, i); }
  std::span<const AxisPart> of_target(int i) const { return range(first_of_target_, i); }

 private:
  std::span<const AxisPart> range(const std::vector<std::size_t>& first, int i) const {
    const auto k = static_cast<std::size_t>(i);
    return {parts_.data() + first[k], first[k + 1] - first[k]};
  }

  std::vector<AxisPart> parts_;
  std::vector<std::size_t> first_of_source_, first_of_target_;  ///< number of the first part of each cell
};

/// The part of a source cell that lies in a target cell.
template <int Dim>
struct GridPart {
  Cell source;
  Cell target;
  Vec<Dim> low, high;  ///< corners, in widths of the source cell from its low corner
  Vec<Dim> centre;     ///< of volume
  double volume;       ///< per radian in axisymmetric grids
};

/// Source and target grid and the parts that their cells share.
template <int Dim>
class GridOverlap {
 public:
  /// Both grids must outlive this. \throws InputError where their domains or geometries differ
  GridOverlap(const Grid<Dim>& source, const Grid<Dim>& target);

  const Grid<Dim>& source() const { return source_; }
  const Grid<Dim>& target() const { return target_; }

  /// Calls body(GridPart) for all parts of a source cell, in a fixed order.
  template <class Body>
  void for_parts_of_source(const Index<Dim>& cell, Body&& body) const {
    Spans along;
    for (int d = 0; d < Dim; ++d) along[at(d)] = axes_[at(d)].of_source(cell[d]);
    for_products(along, body);
  }
  /// Calls body(GridPart) for all parts of a target cell, in a fixed order.
  template <class Body>
  void for_parts_of_target(const Index<Dim>& cell, Body&& body) const {
    Spans along;
    for (int d = 0; d < Dim; ++d) along[at(d)] = axes_[at(d)].of_target(cell[d]);
    for_products(along, body);
  }

 private:
  using Spans = std::array<std::span<const AxisPart>, Dim>;
  static std::size_t at(int d) { return static_cast<std::size_t>(d); }

  template <class Body>
  void for_products(const Spans& along, Body&& body) const {
    std::size_t count = 1;
    for (const auto& parts : along) count *= parts.size();
    for (std::size_t k = 0; k < count; ++k) {
      Index<Dim> source, target;
      GridPart<Dim> part;
      part.volume = 1;
      std::size_t rest = k;
      for (int d = 0; d < Dim; ++d) {
        const AxisPart& p = along[at(d)][rest % along[at(d)].size()];
        rest /= along[at(d)].size();
        source[d] = p.source;
        target[d] = p.target;
        part.low[d] = p.low;
        part.high[d] = p.high;
        part.centre[d] = p.centre;
        part.volume *= p.weight;
      }
      part.source = source_.cell(source);
      part.target = target_.cell(target);
      body(part);
    }
  }

  const Grid<Dim>& source_;
  const Grid<Dim>& target_;
  std::array<AxisOverlap, Dim> axes_;
};

extern template class GridOverlap<2>;
extern template class GridOverlap<3>;

}  // namespace quicksand
