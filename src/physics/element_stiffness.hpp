#pragma once
/// \file
/// Stiffness matrices of single elements.
#include "physics/element_shape.hpp"

namespace quicksand {

/// Stiffness of one element, [corner a][corner b][component][component]; filled for a >= b, the rest follows by
/// symmetry.
template <int Dim, class Real = double>
struct ElementMatrix {
  Real at[corner_count<Dim>][corner_count<Dim>][Dim][Dim] = {};
};

/// Adds the sum over the points of f 1/2 Delta(v):Delta(w) for unit corner velocities v, w.
///
/// With G_kd the derivative of corner k's shape function along d, that is sum_d G_ad G_bd on the diagonal, plus
/// G_aj G_bi - 2/3 G_ai G_bj, summed over the points with weights f. A derivative is a difference along one edge or the
/// mean of two, so sums over pairs of edges, of which few meet in a point, come first.
/// \param f  viscosity times weight at every point
template <int Dim, class Real>
void add_viscous(const ElementShape<Dim, Real>& e, const Real (&f)[point_count<Dim>], ElementMatrix<Dim, Real>& K) {
  constexpr const ElementEdges<Dim>& edges = element_edges<Dim>;
  Real pair[point_count<Dim>][point_count<Dim>] = {};
  for (int q = 0; q < point_count<Dim>; ++q) {
    for (int d = 0; d < 2 * Dim; ++d) {
      const int first = edges.touching[q][d / 2][d % 2];
      for (int b = 0; b < 2 * Dim; ++b) pair[first][edges.touching[q][b / 2][b % 2]] += 0.25 * f[q];
    }
  }
  for (int p = 0; p < point_count<Dim>; ++p) {
    for (int q = 0; q < point_count<Dim>; ++q) {
      const int d = p % Dim;
      const int g = q % Dim;
      const Real value = pair[p][q] * e.inverse_width[d] * e.inverse_width[g];
      for (int ends = 0; ends < 4; ++ends) {
        const int a = ends & 1 ? edges.high[p] : edges.low[p];
        const int b = ends & 2 ? edges.high[q] : edges.low[q];
        if (a < b) continue;
        const Real product = ends == 0 || ends == 3 ? value : -value;  // of G_ad and G_bg
        K.at[a][b][g][d] += product;
        K.at[a][b][d][g] -= 2 * product / 3;
        for (int i = 0; i < Dim && d == g; ++i) K.at[a][b][i][i] += product;
      }
    }
  }
  if (!e.axisymmetric) return;
  for (int q = 0; q < point_count<Dim>; ++q) {
    const Real hoop = 0.5 * inverse_radius(e, q);  // of the two ends of the point's edge
    const auto slope = [&](int k, int d) { return mid_edge_shapes<Dim>.derivative[q][k][d] * e.inverse_width[d]; };
    for (const int end : {edges.low[q], edges.high[q]}) {
      for (int k = 0; k < corner_count<Dim>; ++k) {
        for (int d = 0; d < Dim; ++d) {
          const Real divergence = 2 * f[q] * hoop * slope(k, d) / 3;
          if (k >= end) K.at[k][end][d][0] -= divergence;
          if (end >= k) K.at[end][k][0][d] -= divergence;
        }
      }
      K.at[end][edges.low[q]][0][0] += 4 * f[q] * hoop * hoop / 3;
    }
    K.at[edges.high[q]][edges.high[q]][0][0] += 4 * f[q] * hoop * hoop / 3;
  }
}

/// Adds k sym[(1/2 S:Delta(v)) (1/2 T:Delta(w))] at one point for unit corner velocities v, w.
template <int Dim, class Real>
void add_product(const ElementShape<Dim, Real>& e, int q, const StrainRate<Dim, Real>& S,
                 const StrainRate<Dim, Real>& T, const Real& k, ElementMatrix<Dim, Real>& K) {
  Real s[corner_count<Dim>][Dim];
  Real t[corner_count<Dim>][Dim];
  for (int a = 0; a < corner_count<Dim>; ++a) {
    const Real hoop = mid_edge_shapes<Dim>.value[q][a] * inverse_radius(e, q);
    for (int c = 0; c < Dim; ++c) {
      s[a][c] = c == 0 ? S.third * hoop : Real{};
      t[a][c] = c == 0 ? T.third * hoop : Real{};
      for (int d = 0; d < Dim; ++d) {
        const Real slope = mid_edge_shapes<Dim>.derivative[q][a][d] * e.inverse_width[d];
        s[a][c] += S.delta[c][d] * slope;
        t[a][c] += T.delta[c][d] * slope;
      }
    }
  }
  for (int a = 0; a < corner_count<Dim>; ++a) {
    for (int i = 0; i < Dim; ++i) {
      const Real half_s = 0.5 * k * s[a][i];
      const Real half_t = 0.5 * k * t[a][i];
      for (int b = 0; b <= a; ++b) {
        for (int j = 0; j < Dim; ++j) K.at[a][b][i][j] += half_s * t[b][j] + half_t * s[b][j];
      }
    }
  }
}

}  // namespace quicksand
