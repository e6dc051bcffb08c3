// Elements in packs against elements one by one: a wall that moves next to not at all keeps elements from packs.
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

/// A flow of a Newtonian liquid, Bingham's and a regularised one behind each other along x, with holes.
template <int Dim>
struct LongRow {
  Domain<Dim> domain;
  Mixture<Dim> mixture;
  DiffusionWork<Dim> work;

  static Sides<Dim> sides(Geometry geometry, bool periodic, bool packs) {
    Sides<Dim> sides;
    for (int d = 0; d < Dim; ++d) {
      for (int s = 0; s < 2; ++s) sides.at(d, s).kind = s == 0 ? SideKind::no_slip : SideKind::free_slip;
    }
    if (periodic) sides.at(0, 0).kind = sides.at(0, 1).kind = SideKind::periodic;
    if (geometry == Geometry::axisymmetric) sides.at(0, 0).kind = SideKind::axis;
    if (!packs) sides.at(Dim - 1, 0).velocity[0] = 1e-300;
    return sides;
  }

  LongRow(int n, Geometry geometry, bool periodic, bool packs)
      : domain(grid(n, geometry), sides(geometry, periodic, packs)),
        mixture(domain, {testing::liquid_species(1, Newtonian{0.7}), testing::liquid_species(2, Bingham{0.05, 0.3}),
                         testing::liquid_species(1.5, HerschelBulkley{0.2, 1.6, 0.3, 20})}),
        work(domain, mixture.species) {
    work.acquire(domain.layout());
    const Grid<Dim>& g = domain.grid;
    for_each<Cell>(domain.layout(), g.cells(), [&](Cell c, const Index<Dim>& i) {
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
                          });
    work.rigid_stress = work.multiplier;
  }
  static Grid<Dim> grid(int n, Geometry geometry) {
    std::array<std::vector<double>, static_cast<std::size_t>(Dim)> axes;
    axes.fill(testing::graded_axis(3, 0, 0.3, 2));
    axes[0] = testing::graded_axis(n, 0, 1, 3);
    return {axes, geometry};
  }
  CellVectors<Dim> rough(double seed) const {
    CellVectors<Dim> u = testing::rough_vectors(domain.grid, seed);
    for (int d = 0; d < Dim; ++d) {
      for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) { u[d][c] *= mixture.rho[c] > 0 ? 1 : 0; });
    }
    return u;
  }
};

template <int Dim>
double difference(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellVectors<Dim>& v) {
  double largest = 0;
  for (int d = 0; d < Dim; ++d) {
    largest = std::max(largest, maximum<Cell>(domain.layout(), domain.grid.cells(), 0.0,
                                              [&](Cell c) { return std::abs(u[d][c] - v[d][c]); }));
  }
  return largest;
}

template <int Dim>
void expect_same(int n, Geometry geometry, bool periodic, double seed) {
  SCOPED_TRACE(n);
  LongRow<Dim> packed(n, geometry, periodic, true), single(n, geometry, periodic, false);
  EXPECT_EQ(packed.work.elements.mesh.packed_part(0, n).first == n, n <= pack_width);
  EXPECT_EQ(single.work.elements.mesh.packed_part(0, n).first, n);
  const Domain<Dim>& domain = packed.domain;
  CellVectors<Dim> g(domain.layout()), h(domain.layout());
  const auto on_both = [&](auto&& act) {
    act(packed, g);
    act(single, h);
  };
  const CellVectors<Dim> u = seed > 0 ? packed.rough(seed) : CellVectors<Dim>(domain.layout());
  FunctionalValue values[2];
  for (const bool updated : {false, true}) {
    SCOPED_TRACE(updated);
    on_both([&](LongRow<Dim>& row, CellVectors<Dim>& y) {
      values[&row == &packed] = evaluate_functional(row.domain, row.rough(40), u, dt, row.work, y);
    });
    EXPECT_NEAR(values[0].value, values[1].value, 1e-13 * std::abs(values[0].value));
    EXPECT_NEAR(values[0].gap, values[1].gap, 1e-13 * std::abs(values[0].value));
    EXPECT_LE(difference(domain, g, h), 1e-13);
    for (const auto linearisation : {Linearisation::secant, Linearisation::tangent}) {
      on_both([&](LongRow<Dim>& row, CellVectors<Dim>& y) {
        assemble_matrix(row.domain, u, dt, linearisation, row.work);
        CellVectors<Dim> v = row.rough(7);
        row.work.matrix.apply(v, y);
      });
      EXPECT_LE(difference(domain, g, h), 1e-12);
    }
    // The stresses after this show in the next matrix.
    on_both(
        [&](LongRow<Dim>& row, CellVectors<Dim>&) { update_plastic_stress(row.domain, u, row.rough(21), row.work); });
  }
  on_both(
      [&](LongRow<Dim>& row, CellVectors<Dim>& y) { apply_linear_stress(row.domain, row.rough(7), dt, row.work, y); });
  EXPECT_LE(difference(domain, g, h), 1e-13);
  on_both([&](LongRow<Dim>& row, CellVectors<Dim>& y) { linear_stress_diagonal(row.domain, dt, row.work, y); });
  EXPECT_LE(difference(domain, g, h), 1e-13);
}

template <int Dim>
void expect_same_everywhere(Geometry geometry) {
  for (const bool periodic : {false, true}) {
    if (periodic && geometry == Geometry::axisymmetric) continue;
    SCOPED_TRACE(periodic);
    for (const int n : {pack_width, pack_width + 1, pack_width + 2, 2 * pack_width + 3}) {
      expect_same<Dim>(n, geometry, periodic, 1);
      expect_same<Dim>(n, geometry, periodic, 0);  // at rest Bingham's liquid is rigid, and no other
    }
  }
}

TEST(PhysicsPacks, ElementsInPacksAreThoseOneByOneInThePlane) { expect_same_everywhere<2>(Geometry::planar); }
TEST(PhysicsPacks, ElementsInPacksAreThoseOneByOneRoundAnAxis) { expect_same_everywhere<2>(Geometry::axisymmetric); }
TEST(PhysicsPacks, ElementsInPacksAreThoseOneByOneInSpace) { expect_same_everywhere<3>(Geometry::cartesian); }

}  // namespace
}  // namespace quicksand
