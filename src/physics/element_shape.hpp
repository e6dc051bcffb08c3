#pragma once
/// \file
/// Strain rates and forces of single elements: bilinear (trilinear) on a box, evaluated at the mid-points of its edges.
///
/// `Real` is double, or Pack for elements side by side along x, as many as a pack has numbers. Strain rates and forces
/// are inlined whatever their size: what a caller does not use then costs nothing, and packs stay in registers.
#include "core/pack.hpp"

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

/// Size and place of an element.
template <int Dim, class Real = double>
struct ElementShape {
  Real inverse_width[Dim];
  Real radius[2];  ///< of the two ends along axis 0; 1 unless axisymmetric
  Real measure;    ///< product of the widths
  bool axisymmetric;

  /// Weight of mid-edge point q: its share of the element's volume.
  Real weight(int q) const { return measure / point_count<Dim> * radius_at(q); }
  /// Sum of the points' weights.
  Real volume() const {
    Real v{};
    for (int q = 0; q < point_count<Dim>; ++q) v += weight(q);
    return v;
  }
  Real radius_at(int q) const {
    const double t = mid_edge_shapes<Dim>.position[q][0];
    return (1 - t) * radius[0] + t * radius[1];
  }
};

/// Strain rate at one point: Delta of (30), its hoop component apart, and s = sqrt(1/2 Delta:Delta).
template <int Dim, class Real = double>
struct StrainRate {
  Real delta[Dim][Dim];
  Real third;  ///< Delta of the direction without gradient: hoop, or normal to the plane (2-D only)
  Real scalar;
};

/// One lane of a pack of strain rates, and its replacement.
template <int Dim, class Real>
StrainRate<Dim> lane(const StrainRate<Dim, Real>& s, int l) {
  StrainRate<Dim> one;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) one.delta[i][j] = lane(s.delta[i][j], l);
  }
  one.third = lane(s.third, l);
  one.scalar = lane(s.scalar, l);
  return one;
}
template <int Dim, class Real>
void set_lane(StrainRate<Dim, Real>& s, int l, const StrainRate<Dim>& one) {
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) set_lane(s.delta[i][j], l, one.delta[i][j]);
  }
  set_lane(s.third, l, one.third);
  set_lane(s.scalar, l, one.scalar);
}

/// 1/2 A:B of two symmetric tensors, for which s^2 = inner(Delta, Delta).
template <int Dim, class Real>
Real inner(const StrainRate<Dim, Real>& a, const StrainRate<Dim, Real>& b) {
  Real total = a.third * b.third;
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
template <int Dim, class Real>
Real inverse_radius(const ElementShape<Dim, Real>& e, int q) {
  return e.axisymmetric ? inverse_or_zero(e.radius_at(q)) : Real{};
}

/// Strain rates at all points of an element from its corner velocities (boundary factors applied). The derivative along
/// a point's own edge is the difference of its ends, those across are means over the two edges that touch the ends.
template <int Dim, class Real>
[[gnu::always_inline]] inline void strain_rates(const ElementShape<Dim, Real>& e,
                                                const Real (&u)[corner_count<Dim>][Dim],
                                                StrainRate<Dim, Real> (&rates)[point_count<Dim>]) {
  constexpr const ElementEdges<Dim>& edges = element_edges<Dim>;
  Real slope[point_count<Dim>][Dim];
  for (int q = 0; q < point_count<Dim>; ++q) {
    for (int c = 0; c < Dim; ++c) {
      slope[q][c] = (u[edges.high[q]][c] - u[edges.low[q]][c]) * e.inverse_width[q % Dim];
    }
  }
  for (int q = 0; q < point_count<Dim>; ++q) {
    Real gradient[Dim][Dim];  // [component][axis]
    for (int d = 0; d < Dim; ++d) {
      const auto& touching = edges.touching[q][d];
      for (int c = 0; c < Dim; ++c) gradient[c][d] = 0.5 * (slope[touching[0]][c] + slope[touching[1]][c]);
    }
    const Real hoop = 0.5 * (u[edges.low[q]][0] + u[edges.high[q]][0]) * inverse_radius(e, q);
    Real divergence = hoop;
    for (int d = 0; d < Dim; ++d) divergence += gradient[d][d];
    StrainRate<Dim, Real>& s = rates[q];
    for (int a = 0; a < Dim; ++a) {
      for (int b = 0; b < Dim; ++b) s.delta[a][b] = gradient[a][b] + gradient[b][a];
      s.delta[a][a] -= 2 * divergence / 3;
    }
    s.third = Dim == 2 ? 2 * hoop - 2 * divergence / 3 : Real{};
    s.scalar = square_root(inner(s, s));
  }
}

/// Adds the corner forces of stresses at the points: sum over the points of stress : grad(N_k e_c).
template <int Dim, class Real>
[[gnu::always_inline]] inline void add_forces(const ElementShape<Dim, Real>& e,
                                              const StrainRate<Dim, Real> (&stress)[point_count<Dim>],
                                              Real (&force)[corner_count<Dim>][Dim]) {
  constexpr const ElementEdges<Dim>& edges = element_edges<Dim>;
  Real pull[point_count<Dim>][Dim] = {};  // along the edges
  for (int q = 0; q < point_count<Dim>; ++q) {
    for (int d = 0; d < Dim; ++d) {
      for (const int edge : edges.touching[q][d]) {
        for (int c = 0; c < Dim; ++c) pull[edge][c] += 0.5 * stress[q].delta[c][d];
      }
    }
    const Real hoop = 0.5 * stress[q].third * inverse_radius(e, q);
    force[edges.low[q]][0] += hoop;
    force[edges.high[q]][0] += hoop;
  }
  for (int q = 0; q < point_count<Dim>; ++q) {
    for (int c = 0; c < Dim; ++c) {
      const Real f = pull[q][c] * e.inverse_width[q % Dim];
      force[edges.high[q]][c] += f;
      force[edges.low[q]][c] -= f;
    }
  }
}

}  // namespace quicksand
