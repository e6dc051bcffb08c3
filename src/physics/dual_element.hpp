#pragma once
/// \file
/// Bilinear (trilinear) elements on the dual mesh, whose corners are cell centres and, at the domain's boundary, points
/// on the boundary. One element per node of the grid; the strain rate (30) is evaluated at the mid-points of its edges.
///
/// One point in the middle would leave a checkerboard of velocities without stress; mid-edge points do not, and where
/// an element touches a wall two of them lie on it.
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "core/domain.hpp"
#include "physics/element_shape.hpp"

namespace quicksand {

/// Where an element lies and which cells stand for its corners.
///
/// A corner on the boundary has no velocity of its own: component e there is factor[k][e] times that of the cell next
/// to it (0 where the wall holds it, 1 where it is free), plus wall[k][e] where the wall moves.
///
/// With Real = Pack these are elements side by side along x, none of them at an end of that axis: corners are those of
/// the first one, the others' follow along x, and places and factors are common.
template <int Dim, class Real = double>
struct DualElement : ElementShape<Dim, Real> {
  Cell corner[corner_count<Dim>];
  int place[corner_count<Dim>];  ///< sum of 3^d over the axes d along which the corner's cell is the higher of two
  double factor[corner_count<Dim>][Dim];
  bool moved = false;  ///< whether any wall[k][e] is not zero; only then are they set
  double wall[corner_count<Dim>][Dim];
};

/// Builds the elements of a domain.
template <int Dim>
class DualMesh {
 public:
  explicit DualMesh(const Domain<Dim>& domain);

  /// The element around node n of the grid's nodes() with multi-index i, or a pack of elements from there on.
  template <class Real = double>
  DualElement<Dim, Real> element(Node n, const Index<Dim>& i) const {
    DualElement<Dim, Real> e;
    const auto along_x = [&i](const std::vector<double>& values, int ahead) {
      Real x;
      const int first = i[0] + ahead;
      std::memcpy(&x, &values[static_cast<std::size_t>(first)], sizeof(Real));
      return x;
    };
    const Axis& x = axes_[0];
    e.measure = along_x(x.width, 0);
    e.inverse_width[0] = 1 / e.measure;
    for (int d = 1; d < Dim; ++d) {
      const double width = axes_[static_cast<std::size_t>(d)].width[static_cast<std::size_t>(i[d])];
      e.inverse_width[d] = Real{} + 1 / width;
      e.measure *= width;
    }
    e.axisymmetric = axisymmetric_;
    e.radius[0] = axisymmetric_ ? along_x(x.position, 0) : Real{} + 1;
    e.radius[1] = axisymmetric_ ? along_x(x.position, 1) : Real{} + 1;
    for (int k = 0; k < corner_count<Dim>; ++k) {
      e.corner[k] = high_cell(n);
      e.place[k] = 0;
      for (int c = 0; c < Dim; ++c) e.factor[k][c] = 1;
      for (int d = 0, power = 1; d < Dim; ++d, power *= 3) {
        const bool high = (k >> d) & 1;
        const bool outside_low = !high && i[d] == 0 && !periodic_[d];
        const bool outside_high = high && i[d] == cells_[d];
        if (outside_high || (!high && !outside_low)) {
          e.corner[k] = e.corner[k] + (i[d] == 0 ? cells_[d] - 1 : -1) * step_[d];
        } else {
          e.place[k] += power;
        }
        if (outside_low || outside_high) {
          for (int c = 0; c < Dim; ++c) e.factor[k][c] *= wall_factor_[d][outside_high ? 1 : 0][c];
        }
      }
    }
    if constexpr (lanes<Real> == 1) {
      if (sides_move_) set_wall_velocities(i, e);
    }
    return e;
  }
  /// The part of a row of elements [first, last) along x that element() may take packs from; empty where it is shorter
  /// than a pack, or sides move.
  std::pair<int, int> packed_part(int first, int last) const {
    const int from = std::max(first, 1);
    const int to = std::min(last, cells_[0]);
    return sides_move_ || to - from < pack_width ? std::pair(last, last) : std::pair(from, to);
  }

 private:
  /// Velocities of boundary corners that moving walls and inflow sides hold. Where two sides hold a corner, it rests.
  void set_wall_velocities(const Index<Dim>& i, DualElement<Dim>& e) const;

  struct Axis {
    /// Low boundary point, centres, high boundary point; on a periodic axis the centres of the last cell, of all cells
    /// and of the first one again.
    std::vector<double> position;
    std::vector<double> width;  ///< of the intervals between positions
  };
  std::array<Axis, static_cast<std::size_t>(Dim)> axes_;
  Index<Dim> cells_;
  AxisFlags<Dim> periodic_;
  Step step_[Dim];
  double wall_factor_[Dim][2][Dim];  ///< [axis][side][component]
  bool axisymmetric_;
  SideVelocities<Dim> side_velocities_;
  bool sides_move_;
};

/// Changes of an element's corner velocities for changes of the cells' velocities: boundary factors applied.
template <int Dim, class Real>
[[gnu::always_inline]] inline void gather_change(const DualElement<Dim, Real>& e, const CellVectors<Dim>& change,
                                                 Real (&corner)[corner_count<Dim>][Dim]) {
  for (int k = 0; k < corner_count<Dim>; ++k) {
    for (int c = 0; c < Dim; ++c) corner[k][c] = e.factor[k][c] * load<Real>(change[c], e.corner[k]);
  }
}

/// Corner velocities of an element, those of moving walls included.
template <int Dim, class Real>
[[gnu::always_inline]] inline void gather(const DualElement<Dim, Real>& e, const CellVectors<Dim>& u,
                                          Real (&corner)[corner_count<Dim>][Dim]) {
  gather_change(e, u, corner);
  if (!e.moved) return;
  for (int k = 0; k < corner_count<Dim>; ++k) {
    for (int c = 0; c < Dim; ++c) corner[k][c] += e.wall[k][c];
  }
}

/// The transpose of gather_change(): adds forces on the corners to those on the cells.
template <int Dim>
void scatter(const DualElement<Dim>& e, const double (&force)[corner_count<Dim>][Dim], CellVectors<Dim>& cells) {
  for (int k = 0; k < corner_count<Dim>; ++k) {
    for (int c = 0; c < Dim; ++c) cells[c][e.corner[k]] += e.factor[k][c] * force[k][c];
  }
}
template <int Dim>
[[gnu::always_inline]] inline void scatter(const DualElement<Dim, Pack>& e, const Pack (&force)[corner_count<Dim>][Dim],
                                           CellVectors<Dim>& cells) {
  constexpr Step to_last{pack_width - 1};
  for (int k = 0; k < corner_count<Dim>; k += 2) {
    for (int c = 0; c < Dim; ++c) {
      // The high corners of elements are the low ones of those next to them.
      const Pack high = e.factor[k + 1][c] * force[k + 1][c];
      add_to(cells[c], e.corner[k], e.factor[k][c] * force[k][c] + shifted(high));
      cells[c][e.corner[k + 1] + to_last] += lane(high, pack_width - 1);
    }
  }
}

extern template class DualMesh<2>;
extern template class DualMesh<3>;

}  // namespace quicksand
