#pragma once
/// \file
/// Bilinear (trilinear) elements on the dual mesh, whose corners are cell centres and, at the domain's boundary, points
/// on the boundary. One element per node of the grid; the strain rate (30) is evaluated at the mid-points of its edges.
///
/// One point in the middle would leave a checkerboard of velocities without stress; mid-edge points do not, and where
/// an element touches a wall two of them lie on it.
#include <array>
#include <cmath>
#include <vector>

#include "core/domain.hpp"

namespace quicksand {

/// Number of corners and mid-edge points of an element.
template <int Dim>
inline constexpr int corner_count = 1 << Dim;
template <int Dim>
inline constexpr int point_count = Dim*(1 << (Dim - 1));

/// Shape functions and their derivatives at the mid-edge points of the unit element.
template <int Dim>
struct MidEdgeShapes {
  double value[point_count<Dim>][corner_count<Dim>];
  double derivative[point_count<Dim>][corner_count<Dim>][Dim];
  double position[point_count<Dim>][Dim];

  constexpr MidEdgeShapes() : value{}, derivative{}, position{} {
    for (int q = 0; q < point_count<Dim>; ++q) {
      const int along = q % Dim;  // the edge's direction
      int rest = q / Dim;         // its place in the other axes, bit by bit
      for (int d = 0; d < Dim; ++d) {
        if (d == along) {
          position[q][d] = 0.5;
        } else {
          position[q][d] = rest & 1;
          rest >>= 1;
        }
      }
      for (int k = 0; k < corner_count<Dim>; ++k) {
        value[q][k] = product(q, k, -1);
        for (int d = 0; d < Dim; ++d) derivative[q][k][d] = ((k >> d) & 1 ? 1 : -1) * product(q, k, d);
      }
    }
  }

 private:
  constexpr double product(int q, int k, int without) const {
    double p = 1;
    for (int e = 0; e < Dim; ++e) {
      if (e != without) p *= (k >> e) & 1 ? position[q][e] : 1 - position[q][e];
    }
    return p;
  }
};

template <int Dim>
inline constexpr MidEdgeShapes<Dim> mid_edge_shapes{};

/// Where an element lies and which cells stand for its corners.
///
/// A corner on the boundary has no velocity of its own: component e there is factor[k][e] times that of the cell next
/// to it (0 where the wall holds it, 1 where it is free), plus wall[k][e] where the wall moves.
template <int Dim>
struct DualElement {
  Cell corner[corner_count<Dim>];
  int place[corner_count<Dim>];  ///< sum of 3^d over the axes d along which the corner's cell is the higher of two
  double factor[corner_count<Dim>][Dim];
  bool moved = false;  ///< whether any wall[k][e] is not zero; only then are they set
  double wall[corner_count<Dim>][Dim];
  double inverse_width[Dim];
  double radius[2];  ///< of the two ends along axis 0; 1 unless axisymmetric
  double measure;    ///< product of the widths
  bool axisymmetric;

  /// Weight of mid-edge point q: its share of the element's volume.
  double weight(int q) const { return measure / point_count<Dim> * radius_at(q); }
  /// Sum of the points' weights.
  double volume() const {
    double v = 0;
    for (int q = 0; q < point_count<Dim>; ++q) v += weight(q);
    return v;
  }
  double radius_at(int q) const {
    const double t = mid_edge_shapes<Dim>.position[q][0];
    return (1 - t) * radius[0] + t * radius[1];
  }
};

/// Builds the elements of a domain.
template <int Dim>
class DualMesh {
 public:
  explicit DualMesh(const Domain<Dim>& domain);

  /// The element around node n of the grid's nodes() with multi-index i.
  DualElement<Dim> element(Node n, const Index<Dim>& i) const {
    DualElement<Dim> e;
    e.measure = 1;
    e.axisymmetric = axisymmetric_;
    for (int d = 0; d < Dim; ++d) {
      const double width = axes_[static_cast<std::size_t>(d)].width[static_cast<std::size_t>(i[d])];
      e.inverse_width[d] = 1 / width;
      e.measure *= width;
    }
    e.radius[0] = axisymmetric_ ? axes_[0].position[static_cast<std::size_t>(i[0])] : 1.0;
    e.radius[1] = axisymmetric_ ? axes_[0].position[static_cast<std::size_t>(i[0]) + 1] : 1.0;
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
    if (sides_move_) set_wall_velocities(i, e);
    return e;
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
template <int Dim>
void gather_change(const DualElement<Dim>& e, const CellVectors<Dim>& change,
                   double (&corner)[corner_count<Dim>][Dim]) {
  for (int k = 0; k < corner_count<Dim>; ++k) {
    for (int c = 0; c < Dim; ++c) corner[k][c] = e.factor[k][c] * change[c][e.corner[k]];
  }
}

/// Corner velocities of an element, those of moving walls included.
template <int Dim>
void gather(const DualElement<Dim>& e, const CellVectors<Dim>& u, double (&corner)[corner_count<Dim>][Dim]) {
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

/// Strain rate at one point: Delta of (30), its hoop component apart, and s = sqrt(1/2 Delta:Delta).
template <int Dim>
struct StrainRate {
  double delta[Dim][Dim];
  double third;  ///< Delta of the direction without gradient: hoop, or normal to the plane (2-D only)
  double scalar;
};

/// 1/2 A:B of two symmetric tensors, for which s^2 = inner(Delta, Delta).
template <int Dim>
double inner(const StrainRate<Dim>& a, const StrainRate<Dim>& b) {
  double total = a.third * b.third;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) total += a.delta[i][j] * b.delta[i][j];
  }
  return 0.5 * total;
}

/// The edges of an element, numbered like the points in their middles.
template <int Dim>
struct ElementEdges {
  int low[point_count<Dim>];
  int high[point_count<Dim>];
  int touching[point_count<Dim>][Dim][2];  ///< the edges along an axis that touch the two ends

  constexpr ElementEdges() : low{}, high{}, touching{} {
    for (int q = 0; q < point_count<Dim>; ++q) {
      const int along = q % Dim;
      for (int d = 0, rest = q / Dim; d < Dim; ++d) {
        if (d == along) continue;
        low[q] += (rest & 1) << d;
        rest >>= 1;
      }
      high[q] = low[q] + (1 << along);
    }
    for (int q = 0; q < point_count<Dim>; ++q) {
      for (int d = 0; d < Dim; ++d) {
        for (int p = d; p < point_count<Dim>; p += Dim) {
          if (low[p] == low[q] || high[p] == low[q]) touching[q][d][0] = p;
          if (low[p] == high[q] || high[p] == high[q]) touching[q][d][1] = p;
        }
      }
    }
  }
};

template <int Dim>
inline constexpr ElementEdges<Dim> element_edges{};

/// 1/r at a point, 0 unless axisymmetric. On the axis itself the hoop strain is not defined; points there have no
/// weight.
template <int Dim>
double inverse_radius(const DualElement<Dim>& e, int q) {
  return e.axisymmetric && e.radius_at(q) > 0 ? 1 / e.radius_at(q) : 0.0;
}

/// Strain rates at all points of an element from its corner velocities (boundary factors applied). The derivative along
/// a point's own edge is the difference of its ends, those across are means over the two edges that touch the ends.
template <int Dim>
void strain_rates(const DualElement<Dim>& e, const double (&u)[corner_count<Dim>][Dim],
                  StrainRate<Dim> (&rates)[point_count<Dim>]) {
  constexpr const ElementEdges<Dim>& edges = element_edges<Dim>;
  double slope[point_count<Dim>][Dim];
  for (int q = 0; q < point_count<Dim>; ++q) {
    for (int c = 0; c < Dim; ++c) {
      slope[q][c] = (u[edges.high[q]][c] - u[edges.low[q]][c]) * e.inverse_width[q % Dim];
    }
  }
  for (int q = 0; q < point_count<Dim>; ++q) {
    double gradient[Dim][Dim];  // [component][axis]
    for (int d = 0; d < Dim; ++d) {
      const auto& touching = edges.touching[q][d];
      for (int c = 0; c < Dim; ++c) gradient[c][d] = 0.5 * (slope[touching[0]][c] + slope[touching[1]][c]);
    }
    const double hoop = 0.5 * (u[edges.low[q]][0] + u[edges.high[q]][0]) * inverse_radius(e, q);
    double divergence = hoop;
    for (int d = 0; d < Dim; ++d) divergence += gradient[d][d];
    StrainRate<Dim>& s = rates[q];
    for (int a = 0; a < Dim; ++a) {
      for (int b = 0; b < Dim; ++b) {
        s.delta[a][b] = gradient[a][b] + gradient[b][a] - (a == b ? 2 * divergence / 3 : 0.0);
      }
    }
    s.third = Dim == 2 ? 2 * hoop - 2 * divergence / 3 : 0.0;
    s.scalar = std::sqrt(inner(s, s));
  }
}

/// Adds the corner forces of stresses at the points: sum over the points of stress : grad(N_k e_c).
template <int Dim>
void add_forces(const DualElement<Dim>& e, const StrainRate<Dim> (&stress)[point_count<Dim>],
                double (&force)[corner_count<Dim>][Dim]) {
  constexpr const ElementEdges<Dim>& edges = element_edges<Dim>;
  double pull[point_count<Dim>][Dim] = {};  // along the edges
  for (int q = 0; q < point_count<Dim>; ++q) {
    for (int d = 0; d < Dim; ++d) {
      for (const int edge : edges.touching[q][d]) {
        for (int c = 0; c < Dim; ++c) pull[edge][c] += 0.5 * stress[q].delta[c][d];
      }
    }
    const double hoop = 0.5 * stress[q].third * inverse_radius(e, q);
    force[edges.low[q]][0] += hoop;
    force[edges.high[q]][0] += hoop;
  }
  for (int q = 0; q < point_count<Dim>; ++q) {
    for (int c = 0; c < Dim; ++c) {
      const double f = pull[q][c] * e.inverse_width[q % Dim];
      force[edges.high[q]][c] += f;
      force[edges.low[q]][c] -= f;
    }
  }
}

extern template class DualMesh<2>;
extern template class DualMesh<3>;

}  // namespace quicksand
