#include "physics/viscous_functional.hpp"

#include "physics/element_stiffness.hpp"
#include "physics/rigid_yield.hpp"

namespace quicksand {

namespace {

/// The factor k for which f I + k sym(S Delta) is the derivative of the plastic stress f Delta with respect to Delta,
/// given its present estimate S; reduced where S is so large that the matrix would lose its definiteness.
/// \param f, slope  viscosity of the plastic stress and its derivative
template <int Dim>
double plastic_coefficient(double f, double slope, const StrainRate<Dim>& s, const StrainRate<Dim>& stress) {
  if (!(slope < 0) || !(s.scalar > 0)) return 0;
  const double largest = f * f / -slope;
  const double size = std::sqrt(inner(stress, stress));
  const double reduction = size > largest ? largest / size : 1.0;
  return reduction * slope / (f * s.scalar);
}

/// Largest plastic stress up to the strain rate s: bounded, but for shear thinning.
double plastic_bound(const Rheology& m, double s) {
  const bool thinning = (m.consistency > 0 && m.index < 1) || m.casson_cross > 0;
  return m.regularised_yield_stress() + (thinning ? evaluate(m, s).plastic * s : 0.0);
}

/// S <- f (Delta - dDelta) - k S <Delta, dDelta>: the plastic stress f Delta after a change of -dDelta, linearised.
template <int Dim>
void advance_stress(StrainRate<Dim>& stress, const StrainRate<Dim>& s, const StrainRate<Dim>& ds, double f,
                    double slope) {
  const double turned = -plastic_coefficient(f, slope, s, stress) * inner(s, ds);
  const auto combine = [&](double old, double strain, double d) { return f * (strain - d) + turned * old; };
  stress.third = combine(stress.third, s.third, ds.third);
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) stress.delta[i][j] = combine(stress.delta[i][j], s.delta[i][j], ds.delta[i][j]);
  }
}

/// a A + b B; its scalar means nothing.
template <int Dim>
StrainRate<Dim> combination(double a, const StrainRate<Dim>& A, double b, const StrainRate<Dim>& B) {
  StrainRate<Dim> sum;
  sum.third = a * A.third + b * B.third;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) sum.delta[i][j] = a * A.delta[i][j] + b * B.delta[i][j];
  }
  sum.scalar = 0;
  return sum;
}

/// Weights of an element's points times a factor.
template <int Dim>
struct PointWeights {
  double at[point_count<Dim>];
};
template <int Dim>
PointWeights<Dim> point_weights(const DualElement<Dim>& e, double factor) {
  PointWeights<Dim> weights;
  for (int q = 0; q < point_count<Dim>; ++q) weights.at[q] = factor * e.weight(q);
  return weights;
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
          const double value = e.factor[a][i] * e.factor[b][j] * K.at[a][b][i][j];
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
FunctionalValue evaluate_functional(const Domain<Dim>& domain, const CellVectors<Dim>& u_hat, const CellVectors<Dim>& u,
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
    work.gap[n] = 0;
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    double corner[corner_count<Dim>][Dim];
    gather(e, u, corner);
    StrainRate<Dim> rates[point_count<Dim>];
    strain_rates(e, corner, rates);
    double potential = 0;
    double gap = 0;
    for (int q = 0; q < point_count<Dim>; ++q) {
      const double weight = dt * work.elements.share[n] * e.weight(q);
      StrainRate<Dim>& s = rates[q];  // becomes the stress
      const LawValue law = evaluate(work.elements.rheology[n], s.scalar);
      potential += weight * law.potential;
      if (work.elements.rheology[n].rigid_yield_stress > 0) {
        const RigidYield<Dim> rigid = work.rigid_yield(n, q, s);
        potential += weight * rigid.potential;
        gap += weight * rigid.gap;
        s = combination(weight * law.f, s, weight, rigid.stress);
      } else {
        s = combination(weight * law.f, s, 0, s);
      }
    }
    double force[corner_count<Dim>][Dim] = {};
    add_forces(e, rates, force);
    work.potential[n] = potential;
    work.gap[n] = gap;
    scatter(e, force, gradient);
  });
  return {.value = inertia + sum<Node>(layout, elements, [&](Node n) { return work.potential[n]; }),
          .gap = work.multiplier.size() == 0 ? 0.0 : sum<Node>(layout, elements, [&](Node n) { return work.gap[n]; })};
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
    StrainRate<Dim> rates[point_count<Dim>];
    strain_rates(e, corner, rates);
    ElementMatrix<Dim> K;
    double viscosity[point_count<Dim>];  // times weight
    const bool tangent = linearisation == Linearisation::tangent;
    for (int q = 0; q < point_count<Dim>; ++q) {
      const double weight = dt * work.elements.share[n] * e.weight(q);
      const StrainRate<Dim>& s = rates[q];
      const LawValue law = evaluate(work.elements.rheology[n], s.scalar);
      viscosity[q] = weight * law.f;
      if (tangent && law.plastic > 0) {
        const StrainRate<Dim>& stress = work.stress[n].at[q];
        add_product(e, q, s, stress, weight * plastic_coefficient(law.plastic, law.plastic_slope, s, stress), K);
      }
      const double thickening = law.slope - law.plastic_slope;
      if (tangent && thickening > 0) add_product(e, q, s, s, weight * thickening / s.scalar, K);
      if (!(work.elements.rheology[n].rigid_yield_stress > 0)) continue;
      const RigidYield<Dim> rigid = work.rigid_yield(n, q, s);
      viscosity[q] += weight * rigid.f;
      if (!tangent) continue;
      const StrainRate<Dim>& stress = work.rigid_stress[n].at[q];
      add_product(e, q, rigid.driver, stress, weight * plastic_coefficient(rigid.f, rigid.slope, rigid.driver, stress),
                  K);
    }
    add_viscous(e, viscosity, K);
    scatter(e, K, table, matrix);
  });
  matrix.wrap_couplings();
}

template <int Dim>
void apply_linear_stress(const Domain<Dim>& domain, const CellVectors<Dim>& v, double dt, DiffusionWork<Dim>& work,
                         CellVectors<Dim>& y) {
  const Box<Dim>& cells = work.matrix.box();
  for (int d = 0; d < Dim; ++d) {
    const CellField& mass = work.mass[d];
    for_each<Cell>(domain.layout(), cells, [&](Cell c) { y[d][c] = (mass[c] > 0 ? mass[c] : 1.0) * v[d][c]; });
  }
  for_each_coloured<Node>(domain.layout(), elements_around(domain.grid, cells), [&](Node n, const Index<Dim>& index) {
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    double corner[corner_count<Dim>][Dim];
    gather_change(e, v, corner);
    StrainRate<Dim> rates[point_count<Dim>];
    strain_rates(e, corner, rates);
    const double factor = dt * work.elements.share[n] * work.elements.rheology[n].viscosity;
    for (int q = 0; q < point_count<Dim>; ++q) rates[q] = combination(factor * e.weight(q), rates[q], 0, rates[q]);
    double force[corner_count<Dim>][Dim] = {};
    add_forces(e, rates, force);
    scatter(e, force, y);
  });
}

template <int Dim>
void linear_stress_diagonal(const Domain<Dim>& domain, double dt, DiffusionWork<Dim>& work,
                            CellVectors<Dim>& diagonal) {
  const Box<Dim>& cells = work.matrix.box();
  for (int d = 0; d < Dim; ++d) {
    const CellField& mass = work.mass[d];
    for_each<Cell>(domain.layout(), cells, [&](Cell c) { diagonal[d][c] = mass[c] > 0 ? mass[c] : 1.0; });
  }
  for_each_coloured<Node>(domain.layout(), elements_around(domain.grid, cells), [&](Node n, const Index<Dim>& index) {
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    ElementMatrix<Dim> K;
    add_viscous(e, point_weights(e, dt * work.elements.share[n] * work.elements.rheology[n].viscosity).at, K);
    for (int a = 0; a < corner_count<Dim>; ++a) {
      for (int b = 0; b <= a; ++b) {
        if (!(e.corner[a] == e.corner[b])) continue;  // two corners on the boundary may be one cell
        for (int i = 0; i < Dim; ++i) {
          diagonal[i][e.corner[a]] += (a == b ? 1 : 2) * e.factor[a][i] * e.factor[b][i] * K.at[a][b][i][i];
        }
      }
    }
  });
}

template <int Dim>
void update_plastic_stress(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellVectors<Dim>& update,
                           DiffusionWork<Dim>& work) {
  const bool regularised = work.stress.size() > 0;
  const bool rigid = work.multiplier.size() > 0;
  if (!regularised && !rigid) return;
  for_each_stress_element(domain, u, work, [&](Node n, const DualElement<Dim>& e, const auto& rates) {
    const Rheology& rheology = work.elements.rheology[n];
    double change[corner_count<Dim>][Dim];
    gather_change(e, update, change);
    StrainRate<Dim> changes[point_count<Dim>];
    strain_rates(e, change, changes);
    for (int q = 0; q < point_count<Dim>; ++q) {
      const StrainRate<Dim>& s = rates[q];
      const StrainRate<Dim>& ds = changes[q];
      if (regularised) {
        StrainRate<Dim>& stress = work.stress[n].at[q];
        const LawValue law = evaluate(rheology, s.scalar);
        if (law.plastic > 0) {
          advance_stress(stress, s, ds, law.plastic, law.plastic_slope);
          limit(stress, plastic_bound(rheology, std::max(s.scalar, add_scaled(s, -1, ds).scalar)));
        } else {
          stress = {};
        }
      }
      if (rigid && rheology.rigid_yield_stress > 0) {
        const RigidYield<Dim> point = work.rigid_yield(n, q, s);
        StrainRate<Dim>& stress = work.rigid_stress[n].at[q];
        advance_stress(stress, point.driver, ds, point.f, point.slope);
        limit(stress, rheology.rigid_yield_stress);
      }
    }
  });
}

template <int Dim>
NodeField dual_steps(const Domain<Dim>& domain, double dt, const DiffusionWork<Dim>& work) {
  const Layout<Dim>& layout = domain.layout();
  const Box<Dim> elements = elements_around(domain.grid, work.matrix.box());
  // A cell shares its mass among the corners that it is.
  CellField corners(layout);
  for_each_coloured<Node>(layout, elements, [&](Node n, const Index<Dim>& index) {
    if (!work.elements.active[n]) return;
    for (const Cell c : work.elements.mesh.element(n, index).corner) corners[c] += 1;
  });
  NodeField steps(layout);
  for_each_indexed<Node>(layout, elements, [&](Node n, const Index<Dim>& index) {
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    ElementMatrix<Dim> K;
    add_viscous(e, point_weights(e, dt * work.elements.share[n]).at, K);
    // Row sums of the scaled matrix bound its eigenvalues; the lower half of K stands for both.
    double rows[corner_count<Dim>][Dim] = {};
    const auto scale = [&](int k, int c) {
      const Cell cell = e.corner[k];
      return std::abs(e.factor[k][c]) * std::sqrt(corners[cell] / work.mass[c][cell]);
    };
    for (int a = 0; a < corner_count<Dim>; ++a) {
      for (int b = 0; b <= a; ++b) {
        for (int i = 0; i < Dim; ++i) {
          for (int j = 0; j < Dim; ++j) {
            const double entry = std::abs(K.at[a][b][i][j]) * scale(a, i) * scale(b, j);
            rows[a][i] += entry;
            if (a != b) rows[b][j] += entry;
          }
        }
      }
    }
    double largest = 0;
    for (const auto& row : rows) {
      for (const double r : row) largest = std::max(largest, r);
    }
    steps[n] = (largest > 0 ? 1 / largest : 0.0) + work.elements.rheology[n].viscosity;
  });
  return steps;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                                   \
  template FunctionalValue evaluate_functional(const Domain<Dim>&, const CellVectors<Dim>&, const CellVectors<Dim>&, \
                                               double, DiffusionWork<Dim>&, CellVectors<Dim>&);                      \
  template void assemble_matrix(const Domain<Dim>&, const CellVectors<Dim>&, double, Linearisation,                  \
                                DiffusionWork<Dim>&);                                                                \
  template void apply_linear_stress(const Domain<Dim>&, const CellVectors<Dim>&, double, DiffusionWork<Dim>&,        \
                                    CellVectors<Dim>&);                                                              \
  template void linear_stress_diagonal(const Domain<Dim>&, double, DiffusionWork<Dim>&, CellVectors<Dim>&);          \
  template void update_plastic_stress(const Domain<Dim>&, const CellVectors<Dim>&, const CellVectors<Dim>&,          \
                                      DiffusionWork<Dim>&);                                                          \
  template NodeField dual_steps(const Domain<Dim>&, double, const DiffusionWork<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
