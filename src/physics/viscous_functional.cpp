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

/// The factor k for which f_p I + k sym(S Delta) is the derivative of the plastic stress f_p Delta with respect to
/// Delta, given its present estimate S; reduced where S is so large that the matrix would lose its definiteness.
template <int Dim>
double plastic_coefficient(const LawValue& law, const StrainRate<Dim>& s, const StrainRate<Dim>& stress) {
  const double largest = law.plastic * law.plastic / -law.slope;
  const double size = std::sqrt(inner(stress, stress));
  const double reduction = size > largest ? largest / size : 1.0;
  return reduction * law.slope / (law.plastic * s.scalar);
}

/// Stiffness of one element, [corner a][corner b][component][component]; filled for a >= b, the rest follows by
/// symmetry.
template <int Dim>
using ElementMatrix = double[corner_count<Dim>][corner_count<Dim>][Dim][Dim];

/// Adds f 1/2 Delta(v):Delta(w) + k sym[(1/2 Delta(u):Delta(v)) (1/2 S:Delta(w))] for unit corner velocities v, w.
/// \param stress  S
/// \param k       coefficient of the second term, <= 0
template <int Dim>
void add_point(const PointShapes<Dim>& shapes, const StrainRate<Dim>& s, const StrainRate<Dim>& stress, double f,
               double k, ElementMatrix<Dim>& K) {
  double against[corner_count<Dim>][Dim];
  double against_stress[corner_count<Dim>][Dim];
  for (int n = 0; n < corner_count<Dim>; ++n) {
    for (int c = 0; c < Dim; ++c) {
      against[n][c] = shapes.against(s, n, c);
      against_stress[n][c] = shapes.against(stress, n, c);
    }
  }
  for (int a = 0; a < corner_count<Dim>; ++a) {
    const double(&ga)[Dim] = shapes.gradient[a];
    for (int b = 0; b <= a; ++b) {
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
          const double plastic = against[a][i] * against_stress[b][j] + against_stress[a][i] * against[b][j];
          K[a][b][i][j] += f * strain + 0.5 * k * plastic;
        }
      }
    }
  }
}

/// The elements that have a corner in a box of cells.
template <int Dim>
Box<Dim> elements_around(const Grid<Dim>& grid, Box<Dim> cells) {
  for (int d = 0; d < Dim; ++d) ++cells.hi[d];
  return intersect(cells, grid.nodes());
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

/// Adds an element's stiffness to the matrix. Corners on the boundary share the cells of others, so that two corners
/// may be one cell, or lie the other way round than their numbers.
template <int Dim>
void scatter(const DualElement<Dim>& e, const ElementMatrix<Dim>& K, const OffsetTable<Dim>& table,
             VelocityMatrix<Dim>& matrix) {
  for (int a = 0; a < corner_count<Dim>; ++a) {
    for (int b = 0; b <= a; ++b) {
      const int apart = e.place[a] - e.place[b];
      for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
          const double value = e.factor[a][i] * e.factor[b][j] * K[a][b][i][j];
          if (apart > 0) {
            matrix.lower(i, j, table.of_place[apart])[e.corner[a]] += value;
          } else if (apart < 0) {
            matrix.lower(j, i, table.of_place[-apart])[e.corner[b]] += value;
          } else {
            if (i <= j) matrix.centre(i, j)[e.corner[a]] += value;
            if (a != b && j <= i) matrix.centre(j, i)[e.corner[a]] += value;
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
    for_each<Cell>(layout, cells, [&](Cell c) { gradient[d][c] = work.mass[d][c] * (u[d][c] - u_hat[d][c]); });
    inertia += sum<Cell>(layout, cells, [&](Cell c) { return 0.5 * gradient[d][c] * (u[d][c] - u_hat[d][c]); });
  }
  const Box<Dim> elements = elements_around(domain.grid, cells);
  for_each_coloured<Node>(layout, elements, [&](Node n, const Index<Dim>& index) {
    work.potential[n] = 0;
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    double corner[corner_count<Dim>][Dim];
    gather(e, u, corner);
    double force[corner_count<Dim>][Dim] = {};
    double potential = 0;
    for (int q = 0; q < point_count<Dim>; ++q) {
      const double weight = dt * work.elements.share[n] * e.weight(q);
      if (!(weight > 0)) continue;
      const StrainRate<Dim> s = strain_rate(e, q, corner);
      const LawValue law = evaluate(work.elements.rheology[n], s.scalar);
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
    const CellField& mass = work.mass[d];
    // Cells without part get identity rows.
    for_each<Cell>(layout, matrix.box(), [&](Cell c) { diagonal[c] = mass[c] > 0 ? mass[c] : 1.0; });
  }
  const Box<Dim> elements = elements_around(domain.grid, matrix.box());
  for_each_coloured<Node>(layout, elements, [&](Node n, const Index<Dim>& index) {
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    double corner[corner_count<Dim>][Dim];
    gather(e, u, corner);
    ElementMatrix<Dim> K = {};
    for (int q = 0; q < point_count<Dim>; ++q) {
      const double weight = dt * work.elements.share[n] * e.weight(q);
      if (!(weight > 0)) continue;
      const StrainRate<Dim> s = strain_rate(e, q, corner);
      const LawValue law = evaluate(work.elements.rheology[n], s.scalar);
      double k = 0;
      StrainRate<Dim> stress{};
      if (linearisation == Linearisation::tangent && law.plastic > 0 && s.scalar > 0) {
        stress = work.stress[n].at[q];
        k = weight * plastic_coefficient(law, s, stress);
      }
      add_point(PointShapes<Dim>(e, q), s, stress, weight * law.f, k, K);
    }
    scatter(e, K, table, matrix);
  });
  matrix.wrap_couplings();
}

template <int Dim>
void update_plastic_stress(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellVectors<Dim>& update,
                           DiffusionWork<Dim>& work) {
  if (work.stress.size() == 0) return;
  const Box<Dim> elements = elements_around(domain.grid, work.matrix.box());
  for_each_indexed<Node>(domain.layout(), elements, [&](Node n, const Index<Dim>& index) {
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    const Rheology& rheology = work.elements.rheology[n];
    double corner[corner_count<Dim>][Dim];
    double change[corner_count<Dim>][Dim];
    gather(e, u, corner);
    gather_change(e, update, change);
    for (int q = 0; q < point_count<Dim>; ++q) {
      StrainRate<Dim>& stress = work.stress[n].at[q];
      if (!(e.weight(q) > 0)) continue;
      const StrainRate<Dim> s = strain_rate(e, q, corner);
      const StrainRate<Dim> ds = strain_rate(e, q, change);
      const LawValue law = evaluate(rheology, s.scalar);
      if (!(law.plastic > 0)) {
        stress = {};
        continue;
      }
      // S <- f_p (Delta + dDelta) + k S (Delta . dDelta), with dDelta that of -update.
      const double k = s.scalar > 0 ? plastic_coefficient(law, s, stress) : 0.0;
      const double turned = -k * inner(s, ds);
      const auto combine = [&](double old, double strain, double d) {
        return law.plastic * (strain - d) + turned * old;
      };
      stress.third = combine(stress.third, s.third, ds.third);
      for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) stress.delta[i][j] = combine(stress.delta[i][j], s.delta[i][j], ds.delta[i][j]);
      }
      const double size = std::sqrt(inner(stress, stress));
      if (size > rheology.yield_stress) {
        const double scale = rheology.yield_stress / size;
        stress.third *= scale;
        for (auto& row : stress.delta) {
          for (double& t : row) t *= scale;
        }
      }
    }
  });
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                                  \
  template double evaluate_functional(const Domain<Dim>&, const CellVectors<Dim>&, const CellVectors<Dim>&, double, \
                                      DiffusionWork<Dim>&, CellVectors<Dim>&);                                      \
  template void assemble_matrix(const Domain<Dim>&, const CellVectors<Dim>&, double, Linearisation,                 \
                                DiffusionWork<Dim>&);                                                               \
  template void update_plastic_stress(const Domain<Dim>&, const CellVectors<Dim>&, const CellVectors<Dim>&,         \
                                      DiffusionWork<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
