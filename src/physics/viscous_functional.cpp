#include "physics/viscous_functional.hpp"

namespace quicksand {

namespace {

/// Derivatives of the shape functions at a point, boundary factors left out.
template <int Dim>
struct PointShapes {
  double gradient[corner_count<Dim>][Dim];
  double hoop[corner_count<Dim>];  ///< N / r, 0 unless axisymmetric

  PointShapes(const DualElement<Dim>& e, int q) {
    const double inverse_radius = e.axisymmetric ? 1 / e.radius_at(q) : 0.0;
    for (int k = 0; k < corner_count<Dim>; ++k) {
      for (int d = 0; d < Dim; ++d) gradient[k][d] = mid_edge_shapes<Dim>.derivative[q][k][d] * e.inverse_width[d];
      hoop[k] = mid_edge_shapes<Dim>.value[q][k] * inverse_radius;
    }
  }
  /// Delta : grad (N_k e_c), the strain of a unit velocity at a corner against a strain rate.
  double against(const StrainRate<Dim>& s, int k, int c) const {
    double t = c == 0 ? s.third * hoop[k] : 0.0;
    for (int d = 0; d < Dim; ++d) t += s.delta[c][d] * gradient[k][d];
    return t;
  }
};

/// Stiffness of one element, [corner a][corner b][component][component].
template <int Dim>
using ElementMatrix = double[corner_count<Dim>][corner_count<Dim>][Dim][Dim];

/// Adds weight { f 1/2 Delta(v):Delta(w) + f'/s (1/2 Delta(u):Delta(v)) (1/2 Delta(u):Delta(w)) } for unit corner velocities v, w.
template <int Dim>
void add_point(const PointShapes<Dim>& shapes, const StrainRate<Dim>& s, double weight_f, double weight_f_prime,
               ElementMatrix<Dim>& K) {
  double against[corner_count<Dim>][Dim];
  for (int k = 0; k < corner_count<Dim>; ++k) {
    for (int c = 0; c < Dim; ++c) against[k][c] = shapes.against(s, k, c);
  }
  for (int a = 0; a < corner_count<Dim>; ++a) {
    const double(&ga)[Dim] = shapes.gradient[a];
    for (int b = 0; b < corner_count<Dim>; ++b) {
      const double(&gb)[Dim] = shapes.gradient[b];
      double dot = 0;
      for (int d = 0; d < Dim; ++d) dot += ga[d] * gb[d];
      for (int i = 0; i < Dim; ++i) {
        const double div_a = ga[i] + (i == 0 ? shapes.hoop[a] : 0.0);
        for (int j = 0; j < Dim; ++j) {
          const double div_b = gb[j] + (j == 0 ? shapes.hoop[b] : 0.0);
          double strain = ga[j] * gb[i] - 2 * div_a * div_b / 3;
          if (i == j) strain += dot;
          if (i == 0 && j == 0) strain += 2 * shapes.hoop[a] * shapes.hoop[b];
          K[a][b][i][j] += weight_f * strain + weight_f_prime * against[a][i] * against[b][j];
        }
      }
    }
  }
}

/// Number of the lower offset whose cells lie `place` (base 3) apart.
template <int Dim>
struct OffsetTable {
  std::size_t of_place[Dim == 2 ? 5 : 14] = {};

  explicit OffsetTable(const std::vector<Index<Dim>>& offsets) {
    for (std::size_t e = 0; e < offsets.size(); ++e) {
      int place = 0;
      for (int d = Dim - 1; d >= 0; --d) place = 3 * place - offsets[e][d];
      of_place[place] = e;
    }
  }
};

template <int Dim>
void scatter(const DualElement<Dim>& e, const ElementMatrix<Dim>& K, const OffsetTable<Dim>& table,
             VelocityMatrix<Dim>& matrix) {
  for (int a = 0; a < corner_count<Dim>; ++a) {
    for (int b = 0; b < corner_count<Dim>; ++b) {
      const int apart = e.place[a] - e.place[b];
      if (apart < 0) continue;
      const Cell c = e.corner[a];
      for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
          const double value = e.factor[a][i] * e.factor[b][j] * K[a][b][i][j];
          if (apart > 0) {
            matrix.lower(i, j, table.of_place[apart])[c] += value;
          } else if (i <= j) {
            matrix.centre(i, j)[c] += value;
          }
        }
      }
    }
  }
}

}  // namespace

template <int Dim>
double evaluate_functional(const Domain<Dim>& domain, const CellVectors<Dim>& u_hat, const CellVectors<Dim>& u,
                           double dt, DiffusionWork<Dim>& work, CellVectors<Dim>& gradient) {
  const Layout<Dim>& layout = domain.layout();
  const Box<Dim>& cells = work.matrix.box();
  double inertia = 0;
  for (int d = 0; d < Dim; ++d) {
    for_each<Cell>(layout, cells, [&](Cell c) { gradient[d][c] = work.mass[c] * (u[d][c] - u_hat[d][c]); });
    inertia += sum<Cell>(layout, cells, [&](Cell c) { return 0.5 * gradient[d][c] * (u[d][c] - u_hat[d][c]); });
  }
  Box<Dim> elements = cells;
  for (int d = 0; d < Dim; ++d) ++elements.hi[d];
  for_each_coloured<Node>(layout, elements, [&](Node n, const Index<Dim>& index) {
    work.potential[n] = 0;
    if (!work.active[n]) return;
    const DualElement<Dim> e = work.mesh.element(n, index);
    double corner[corner_count<Dim>][Dim];
    gather(e, u, corner);
    double force[corner_count<Dim>][Dim] = {};
    double potential = 0;
    for (int q = 0; q < point_count<Dim>; ++q) {
      const double weight = dt * e.weight(q);
      if (!(weight > 0)) continue;
      const StrainRate<Dim> s = strain_rate(e, q, corner);
      const LawValue law = evaluate(work.rheology[n], s.scalar);
      potential += weight * law.potential;
      const PointShapes<Dim> shapes(e, q);
      for (int k = 0; k < corner_count<Dim>; ++k) {
        for (int c = 0; c < Dim; ++c) force[k][c] += weight * law.f * shapes.against(s, k, c);
      }
    }
    work.potential[n] = potential;
    for (int k = 0; k < corner_count<Dim>; ++k) {
      for (int c = 0; c < Dim; ++c) gradient[c][e.corner[k]] += e.factor[k][c] * force[k][c];
    }
  });
  return inertia + sum<Node>(layout, elements, [&](Node n) { return work.potential[n]; });
}

template <int Dim>
void assemble_matrix(const Domain<Dim>& domain, const CellVectors<Dim>& u, double dt, Linearisation linearisation,
                     DiffusionWork<Dim>& work) {
  const Layout<Dim>& layout = domain.layout();
  VelocityMatrix<Dim>& matrix = work.matrix;
  const OffsetTable<Dim> table(matrix.offsets());
  matrix.clear();
  for (int d = 0; d < Dim; ++d) {
    CellField& diagonal = matrix.centre(d, d);
    // Cells without part get identity rows.
    for_each<Cell>(layout, matrix.box(), [&](Cell c) { diagonal[c] = work.mass[c] > 0 ? work.mass[c] : 1.0; });
  }
  Box<Dim> elements = matrix.box();
  for (int d = 0; d < Dim; ++d) ++elements.hi[d];
  for_each_coloured<Node>(layout, elements, [&](Node n, const Index<Dim>& index) {
    if (!work.active[n]) return;
    const DualElement<Dim> e = work.mesh.element(n, index);
    double corner[corner_count<Dim>][Dim];
    gather(e, u, corner);
    ElementMatrix<Dim> K = {};
    for (int q = 0; q < point_count<Dim>; ++q) {
      const double weight = dt * e.weight(q);
      if (!(weight > 0)) continue;
      const StrainRate<Dim> s = strain_rate(e, q, corner);
      const LawValue law = evaluate(work.rheology[n], s.scalar);
      const double tangent = linearisation == Linearisation::tangent ? law.f_prime_s : 0.0;
      add_point(PointShapes<Dim>(e, q), s, weight * law.f, weight * tangent, K);
    }
    scatter(e, K, table, matrix);
  });
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                                    \
  template double evaluate_functional(const Domain<Dim>&, const CellVectors<Dim>&, const CellVectors<Dim>&, double,   \
                                      DiffusionWork<Dim>&, CellVectors<Dim>&);                                        \
  template void assemble_matrix(const Domain<Dim>&, const CellVectors<Dim>&, double, Linearisation,                   \
                                DiffusionWork<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
