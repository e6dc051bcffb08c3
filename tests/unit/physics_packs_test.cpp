// Elements in packs against elements one by one: the same flow along x, where packs are, and along the last axis, where
// rows are too short for them.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "physics/active_elements.hpp"
#include "physics/viscous_functional.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

constexpr double dt = 0.1;

TEST(CorePack, NumbersMoveToTheNextLaneAndRootsAndInversesAreThoseOfEachNumber) {
  Pack x;
  for (int l = 0; l < pack_width; ++l) x[l] = l - 1.0;
  const Pack moved = shifted(x);
  const Pack inverse = inverse_or_zero(x);
  const Pack root = square_root(x * x);
  for (int l = 0; l < pack_width; ++l) {
    EXPECT_EQ(moved[l], l == 0 ? 0 : x[l - 1]);
    EXPECT_EQ(inverse[l], inverse_or_zero(x[l]));
    EXPECT_EQ(root[l], std::abs(x[l]));
  }
  EXPECT_TRUE(any(x));
  EXPECT_FALSE(any(Pack{}));
}

/// A flow of a Newtonian liquid, Bingham's and a regularised one behind each other, with holes, along x or turned.
template <int Dim>
struct LongRow {
  bool turned;
  Domain<Dim> domain;
  Mixture<Dim> mixture;
  DiffusionWork<Dim> work;

  static Grid<Dim> grid(int n, bool turned) {
    std::array<std::vector<double>, static_cast<std::size_t>(Dim)> axes;
    axes.fill(testing::graded_axis(3, 0, 0.3, 2));
    axes[0] = testing::graded_axis(n, 0, 1, 3);
    if (turned) std::swap(axes.front(), axes.back());
    return {axes, Dim == 2 ? Geometry::planar : Geometry::cartesian};
  }
  static Sides<Dim> sides(bool periodic, bool turned) {
    Sides<Dim> sides;
    for (int d = 0; d < Dim; ++d) {
      for (int s = 0; s < 2; ++s) sides.at(d, s).kind = s == 0 ? SideKind::no_slip : SideKind::free_slip;
    }
    const int along = turned ? Dim - 1 : 0;
    if (periodic) sides.at(along, 0).kind = sides.at(along, 1).kind = SideKind::periodic;
    return sides;
  }

  LongRow(int n, bool periodic, bool turned_in)
      : turned(turned_in),
        domain(grid(n, turned), sides(periodic, turned)),
        mixture(domain, {testing::liquid_species(1, Newtonian{0.7}), testing::liquid_species(2, Bingham{0.05, 0.3}),
                         testing::liquid_species(1.5, Papanastasiou{0.05, 0.3, 20})}),
        work(domain, mixture.species) {
    const Grid<Dim>& g = domain.grid;
    for_each_indexed<Cell>(domain.layout(), g.cells(), [&](Cell c, Index<Dim> i) {
      i = turn(i);
      const bool hole = testing::rough(i, 5) > 0.85;
      const double where = 3.0 * i[0] / n;
      for (std::size_t s = 0; s < 3; ++s) {
        mixture.phi[s][c] = hole ? 0.0 : std::clamp(1 - std::abs(where - 0.5 - double(s)), 0.0, 1.0);
      }
    });
    mixture.update();
    mark_stress_elements(domain, mixture.species, mixture.phi, mixture.total, work.elements);
    for (int e = 0; e < Dim; ++e) {
      for_each<Cell>(domain.layout(), g.cells(), [&](Cell c) { work.mass[e][c] = mixture.rho[c] * g.volume(c); });
    }
    work.matrix.set_box(g.cells());
    work.penalty = 0.02;
    for_each_stress_point(domain, rough(60), work,
                          [&](Node m, const DualElement<Dim>&, int q, const StrainRate<Dim>& s) {
                            work.multiplier[m].at[q] = work.rigid_yield(m, q, s).stress;
                            work.rigid_stress[m] = work.multiplier[m];
                          });
  }
  Index<Dim> turn(Index<Dim> i) const {
    if (turned) std::swap(i[0], i[Dim - 1]);
    return i;
  }
  int component(int d) const { return !turned || (d > 0 && d < Dim - 1) ? d : Dim - 1 - d; }
  CellVectors<Dim> rough(double seed) const {
    CellVectors<Dim> u(domain.layout());
    for_each_indexed<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<Dim>& i) {
      for (int d = 0; d < Dim; ++d) {
        u[d][c] = mixture.rho[c] > 0 ? testing::rough(turn(i), seed + component(d)) : 0.0;
      }
    });
    return u;
  }
};

/// Largest difference of two vector fields, one of them turned.
template <int Dim>
double difference(const LongRow<Dim>& a, const CellVectors<Dim>& u, const LongRow<Dim>& b, const CellVectors<Dim>& v) {
  double largest = 0;
  for_each_indexed<Cell>(a.domain.layout(), a.domain.grid.cells(), [&](Cell c, const Index<Dim>& i) {
    const Cell turned = b.domain.grid.cell(b.turn(i));
    for (int d = 0; d < Dim; ++d) largest = std::max(largest, std::abs(u[d][c] - v[b.component(d)][turned]));
  });
  return largest;
}

template <int Dim>
void expect_same(int n, bool periodic, const auto& velocity) {
  SCOPED_TRACE(n);
  LongRow<Dim> along(n, periodic, false), turned(n, periodic, true);
  const auto evaluate = [&](LongRow<Dim>& row, CellVectors<Dim>& gradient) {
    return evaluate_functional(row.domain, row.rough(40), velocity(row), dt, row.work, gradient);
  };
  CellVectors<Dim> g(along.domain.layout()), h(turned.domain.layout());
  for (const bool updated : {false, true}) {
    const FunctionalValue a = evaluate(along, g);
    const FunctionalValue b = evaluate(turned, h);
    EXPECT_NEAR(a.value, b.value, 1e-13 * std::abs(a.value));
    EXPECT_NEAR(a.gap, b.gap, 1e-13 * std::abs(a.value));
    EXPECT_LE(difference(along, g, turned, h), 1e-13);
    for (const auto linearisation : {Linearisation::secant, Linearisation::tangent}) {
      for (LongRow<Dim>* row : {&along, &turned}) {
        assemble_matrix(row->domain, velocity(*row), dt, linearisation, row->work);
        CellVectors<Dim> v = row->rough(7);
        row->work.matrix.apply(v, row == &along ? g : h);
      }
      EXPECT_LE(difference(along, g, turned, h), 1e-12) << updated;
    }
    // The stresses after this show in the next matrix.
    for (LongRow<Dim>* row : {&along, &turned}) {
      update_plastic_stress(row->domain, velocity(*row), row->rough(21), row->work);
    }
  }
  for (LongRow<Dim>* row : {&along, &turned}) {
    apply_linear_stress(row->domain, row->rough(7), dt, row->work, row == &along ? g : h);
  }
  EXPECT_LE(difference(along, g, turned, h), 1e-13);
  for (LongRow<Dim>* row : {&along, &turned}) {
    linear_stress_diagonal(row->domain, dt, row->work, row == &along ? g : h);
  }
  EXPECT_LE(difference(along, g, turned, h), 1e-13);
}

template <int Dim>
void expect_same_everywhere() {
  for (const bool periodic : {false, true}) {
    SCOPED_TRACE(periodic);
    for (const int n : {pack_width, pack_width + 1, pack_width + 2, 2 * pack_width + 3}) {
      expect_same<Dim>(n, periodic, [](const LongRow<Dim>& row) { return row.rough(1); });
      // At rest every point of Bingham's liquid is rigid, and no other's.
      expect_same<Dim>(n, periodic, [](const LongRow<Dim>& row) { return CellVectors<Dim>(row.domain.layout()); });
    }
  }
}

TEST(PhysicsPacks, ElementsInPacksAreThoseOneByOneInThePlane) { expect_same_everywhere<2>(); }
TEST(PhysicsPacks, ElementsInPacksAreThoseOneByOneInSpace) { expect_same_everywhere<3>(); }

}  // namespace
}  // namespace quicksand
