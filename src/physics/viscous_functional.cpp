#include "physics/viscous_functional.hpp"

#include "physics/active_elements.hpp"
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

/// A += b B; its scalar means nothing.
template <int Dim, class Real>
void add(StrainRate<Dim, Real>& A, const Real& b, const StrainRate<Dim, Real>& B) {
  A.third += b * B.third;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) A.delta[i][j] += b * B.delta[i][j];
  }
}

/// Strain rates at the points of an element that moves with velocities u.
template <int Dim, class Real>
struct PointRates {
  StrainRate<Dim, Real> at[point_count<Dim>];

  PointRates(const DualElement<Dim, Real>& e, const CellVectors<Dim>& u) {
    Real corner[corner_count<Dim>][Dim];
    gather(e, u, corner);
    strain_rates(e, corner, at);
  }
};

/// Stresses at the points of an element, times their weights, become forces on the cells.
template <int Dim, class Real>
[[gnu::always_inline]] inline void scatter_stress(const DualElement<Dim, Real>& e,
                                                  const StrainRate<Dim, Real> (&stress)[point_count<Dim>],
                                                  CellVectors<Dim>& cells) {
  Real force[corner_count<Dim>][Dim] = {};
  add_forces(e, stress, force);
  scatter(e, force, cells);
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
template <int Dim, class Real>
void scatter(const DualElement<Dim, Real>& e, const ElementMatrix<Dim, Real>& K, const OffsetTable<Dim>& table,
             VelocityMatrix<Dim>& matrix) {
  for (int a = 0; a < corner_count<Dim>; ++a) {
    for (int b = 0; b <= a; ++b) {
      const int apart = e.place[a] - e.place[b];
      for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
          const Real value = e.factor[a][i] * e.factor[b][j] * K.at[a][b][i][j];
          if (apart > 0) {
            add_to(matrix.lower(i, j, table.of_place[apart]), e.corner[a], value);
          } else if (apart < 0) {
            add_to(matrix.lower(j, i, table.of_place[-apart]), e.corner[b], value);
          } else {
            if (i <= j) add_to(matrix.centre(i, j), e.corner[a], value);
            if (a != b && j <= i) add_to(matrix.centre(j, i), e.corner[a], value);
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
  const bool rigid = work.multiplier.size() > 0;
  for_each<Node>(layout, elements, [&](Node n) { work.potential[n] = 0; });
  if (rigid) for_each<Node>(layout, elements, [&](Node n) { work.gap[n] = 0; });
  for_each_active_element(layout, elements, work.elements, [&]<class Element>(const Element& e) {
    using Real = typename Element::Number;
    PointRates<Dim, Real> rates(e, u);
    const ElementMaterial<Dim, Real> material(work.elements, e);
    Real potential{};
    Real gap{};
    for (int q = 0; q < point_count<Dim>; ++q) {
      const Real weight = dt * e.share * e.weight(q);
      const StrainRate<Dim, Real>& s = rates.at[q];
      Real f = material.viscosity();
      Real point_potential = 0.5 * f * s.scalar * s.scalar;
      if (material.nonlinear()) {
        material.evaluate_lanes(s.scalar, [&](int l, const LawValue& law) {
          set_lane(f, l, law.f);
          set_lane(point_potential, l, law.potential);
        });
      }
      StrainRate<Dim, Real> stress{};
      if (material.rigid()) {
        Real point_gap{};
        for (int l = 0; l < lanes<Real>; ++l) {
          if (!material.rigid(l)) continue;
          const RigidYield<Dim> yield = work.rigid_yield(e.node + Step{l}, q, lane(s, l));
          set_lane(stress, l, yield.stress);
          set_lane(point_potential, l, lane(point_potential, l) + yield.potential);
          set_lane(point_gap, l, yield.gap);
        }
        gap += weight * point_gap;
      }
      add(stress, f, s);
      potential += weight * point_potential;
      StrainRate<Dim, Real> weighted{};
      add(weighted, weight, stress);
      rates.at[q] = weighted;
    }
    scatter_stress(e, rates.at, gradient);
    add_to(work.potential, e.node, potential);
    if (rigid) add_to(work.gap, e.node, gap);
  });
  return {.value = inertia + sum<Node>(layout, elements, [&](Node n) { return work.potential[n]; }),
          .gap = rigid ? sum<Node>(layout, elements, [&](Node n) { return work.gap[n]; }) : 0.0};
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
  const bool tangent = linearisation == Linearisation::tangent;
  for_each_active_element(layout, elements, work.elements, [&]<class Element>(const Element& e) {
    using Real = typename Element::Number;
    const PointRates<Dim, Real> rates(e, u);
    const ElementMaterial<Dim, Real> material(work.elements, e);
    ElementMatrix<Dim, Real> K;
    Real viscosity[point_count<Dim>];  // times weight
    for (int q = 0; q < point_count<Dim>; ++q) {
      const Real weight = dt * e.share * e.weight(q);
      const StrainRate<Dim, Real>& s = rates.at[q];
      Real f = material.viscosity();
      if (material.nonlinear()) {
        StrainRate<Dim, Real> stress{};
        Real plastic{};
        Real thickening{};
        material.evaluate_lanes(s.scalar, [&](int l, const LawValue& law) {
          set_lane(f, l, law.f);
          if (!tangent) return;
          if (law.plastic > 0) {
            const StrainRate<Dim>& own = work.stress[e.node + Step{l}].at[q];
            set_lane(stress, l, own);
            set_lane(plastic, l, plastic_coefficient(law.plastic, law.plastic_slope, lane(s, l), own));
          }
          const double slope = law.slope - law.plastic_slope;
          if (slope > 0) set_lane(thickening, l, slope / lane(s.scalar, l));
        });
        if (any(plastic)) add_product(e, q, s, stress, weight * plastic, K);
        if (any(thickening)) add_product(e, q, s, s, weight * thickening, K);
      }
      if (material.rigid()) {
        StrainRate<Dim, Real> driver{};
        StrainRate<Dim, Real> stress{};
        Real plastic{};
        for (int l = 0; l < lanes<Real>; ++l) {
          if (!material.rigid(l)) continue;
          const RigidYield<Dim> rigid = work.rigid_yield(e.node + Step{l}, q, lane(s, l));
          set_lane(f, l, lane(f, l) + rigid.f);
          const StrainRate<Dim>& own = work.rigid_stress[e.node + Step{l}].at[q];
          set_lane(driver, l, rigid.driver);
          set_lane(stress, l, own);
          set_lane(plastic, l, plastic_coefficient(rigid.f, rigid.slope, rigid.driver, own));
        }
        if (tangent && any(plastic)) add_product(e, q, driver, stress, weight * plastic, K);
      }
      viscosity[q] = weight * f;
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
  for_each<Cell>(domain.layout(), cells, [&](Cell c) {
    for (int d = 0; d < Dim; ++d) y[d][c] = (work.mass[d][c] > 0 ? work.mass[d][c] : 1.0) * v[d][c];
  });
  const Box<Dim> elements = elements_around(domain.grid, cells);
  for_each_active_element(domain.layout(), elements, work.elements, [&]<class Element>(const Element& e) {
    using Real = typename Element::Number;
    Real corner[corner_count<Dim>][Dim];
    gather_change(e, v, corner);
    StrainRate<Dim, Real> rates[point_count<Dim>];
    strain_rates(e, corner, rates);
    const Real factor = dt * e.share * ElementMaterial<Dim, Real>(work.elements, e).viscosity();
    StrainRate<Dim, Real> stress[point_count<Dim>] = {};
    for (int q = 0; q < point_count<Dim>; ++q) add<Dim, Real>(stress[q], factor * e.weight(q), rates[q]);
    scatter_stress(e, stress, y);
  });
}

template <int Dim>
void linear_stress_diagonal(const Domain<Dim>& domain, double dt, DiffusionWork<Dim>& work,
                            CellVectors<Dim>& diagonal) {
  const Box<Dim>& cells = work.matrix.box();
  for_each<Cell>(domain.layout(), cells, [&](Cell c) {
    for (int d = 0; d < Dim; ++d) diagonal[d][c] = work.mass[d][c] > 0 ? work.mass[d][c] : 1.0;
  });
  const Box<Dim> elements = elements_around(domain.grid, cells);
  for_each_active_element(domain.layout(), elements, work.elements, [&]<class Element>(const Element& e) {
    using Real = typename Element::Number;
    const Real factor = dt * e.share * ElementMaterial<Dim, Real>(work.elements, e).viscosity();
    for (int a = 0; a < corner_count<Dim>; ++a) {
      for (int i = 0; i < Dim; ++i) {
        // The cell moves by itself: all corners that it is, of which one speaks for it.
        Real corner[corner_count<Dim>][Dim] = {};
        bool first = true;
        for (int b = 0; b < corner_count<Dim>; ++b) {
          if (!(e.corner[b] == e.corner[a])) continue;
          first = first && b >= a;
          corner[b][i] = Real{} + e.factor[b][i];
        }
        if (!first) continue;
        StrainRate<Dim, Real> rates[point_count<Dim>];
        strain_rates(e, corner, rates);
        Real stiffness{};
        for (int q = 0; q < point_count<Dim>; ++q) stiffness += e.weight(q) * inner(rates[q], rates[q]);
        add_to(diagonal[i], e.corner[a], factor * stiffness);
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
  const Box<Dim> elements = elements_around(domain.grid, work.matrix.box());
  for_each_active_element(domain.layout(), elements, work.elements, [&]<class Element>(const Element& e) {
    using Real = typename Element::Number;
    const PointRates<Dim, Real> rates(e, u);
    Real change[corner_count<Dim>][Dim];
    gather_change(e, update, change);
    StrainRate<Dim, Real> changes[point_count<Dim>];
    strain_rates(e, change, changes);
    for (int l = 0; l < lanes<Real>; ++l) {
      if (!e.on(l)) continue;
      const Node n = e.node + Step{l};
      const Rheology& rheology = work.elements.rheology[n];
      for (int q = 0; q < point_count<Dim>; ++q) {
        const StrainRate<Dim> s = lane(rates.at[q], l);
        const StrainRate<Dim> ds = lane(changes[q], l);
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
  for_each<Node>(layout, elements, [&](Node n, const Index<Dim>& index) {
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    double weights[point_count<Dim>];
    for (int q = 0; q < point_count<Dim>; ++q) weights[q] = dt * work.elements.share[n] * e.weight(q);
    ElementMatrix<Dim> K;
    add_viscous(e, weights, K);
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
