// The functional of viscoplastic diffusion: its gradient, its matrix, and motions that carry no stress.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "physics/velocity_solver.hpp"
#include "physics/viscous_functional.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

constexpr double dt = 0.1;
const Law newtonian = Newtonian{0.7};
const Law bingham = Papanastasiou{0.05, 0.3, 20};
const Law every_law[] = {newtonian,
                         bingham,
                         HerschelBulkley{0.2, 0.5, 0.3, 20},
                         HerschelBulkley{0.2, 1.6, 0.3, 20},
                         Casson{0.2, 0.3, 20},
                         Bingham{0.05, 0.3}};

/// A mixture made ready for the functional.
template <int Dim>
struct Problem {
  Domain<Dim> domain;
  Mixture<Dim> mixture;
  DiffusionWork<Dim> work;
  CellVectors<Dim> u_hat;

  template <class Make>
  Problem(Domain<Dim> d, const Law& law, Make&& make)
      : domain(std::move(d)),
        mixture(make(domain, testing::liquid_species(1.3, law))),
        work(domain, mixture.species),
        u_hat(testing::rough_vectors(domain.grid, 40)) {
    work.acquire(domain.layout());
    mark_stress_elements(domain, mixture.species, mixture.phi, mixture.total, work.elements);
    for (int e = 0; e < Dim; ++e) {
      for_each<Cell>(domain.layout(), domain.grid.cells(),
                     [&](Cell c) { work.mass[e][c] = mixture.rho[c] * domain.grid.volume(c); });
    }
    work.matrix.set_box(domain.grid.cells());
    if (work.multiplier.size() == 0) return;
    // Multipliers and a penalty such that some points are rigid and others yield.
    work.penalty = 0.02;
    for_each_stress_point(domain, rough(60), work,
                          [&](Node n, const DualElement<Dim>&, int q, const StrainRate<Dim>& s) {
                            work.multiplier[n].at[q] = work.rigid_yield(n, q, s).stress;
                          });
  }

  double value(const CellVectors<Dim>& u) {
    CellVectors<Dim> gradient(domain.layout());
    return evaluate_functional(domain, u_hat, u, dt, work, gradient).value;
  }
  CellVectors<Dim> gradient(const CellVectors<Dim>& u) {
    CellVectors<Dim> g(domain.layout());
    evaluate_functional(domain, u_hat, u, dt, work, g);
    return g;
  }
  CellVectors<Dim> times_matrix(CellVectors<Dim> v) {
    CellVectors<Dim> y(domain.layout());
    work.matrix.apply(v, y);
    return y;
  }
  double product(const CellVectors<Dim>& a, const CellVectors<Dim>& b) {
    return dot<Cell>(domain.layout(), domain.grid.cells(), a, b);
  }
  CellVectors<Dim> combination(const CellVectors<Dim>& a, double factor, const CellVectors<Dim>& b) {
    CellVectors<Dim> y(domain.layout());
    for (int d = 0; d < Dim; ++d) {
      for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) { y[d][c] = a[d][c] + factor * b[d][c]; });
    }
    return y;
  }
  /// Rough velocities where there is mass: other cells take no part and have identity rows.
  CellVectors<Dim> rough(double seed) const {
    CellVectors<Dim> u = testing::rough_vectors(domain.grid, seed);
    for (int d = 0; d < Dim; ++d) {
      for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) { u[d][c] *= work.mass[d][c] > 0 ? 1 : 0; });
    }
    return u;
  }
  double size(const CellVectors<Dim>& a) { return std::sqrt(product(a, a)); }
};

/// Liquid everywhere but in a few corner cells.
template <int Dim>
Mixture<Dim> nearly_full(const Domain<Dim>& domain, const Species& species) {
  Mixture<Dim> mixture(domain, {species});
  testing::set_cells(domain.grid, mixture.phi[0], [](const Vec<Dim>& x) {
    double s = 0;
    for (int d = 0; d < Dim; ++d) s += x[d];
    return std::clamp((0.85 * Dim - s) * 4, 0.0, 1.0);
  });
  mixture.update();
  return mixture;
}

/// Calls test(setup) in every geometry with walls that liquid sticks to and with free ones.
template <class Test>
void in_every_geometry(const Law& law, Test&& test) {
  for (const SideKind kind : {SideKind::no_slip, SideKind::free_slip, SideKind::open}) {
    SCOPED_TRACE(static_cast<int>(kind));
    test(Problem<2>(testing::make_domain(testing::stretched_grid(7), kind), law, nearly_full<2>));
    test(Problem<2>(testing::make_domain(testing::tank_grid(6), kind), law, nearly_full<2>));
    test(Problem<3>(testing::make_domain(testing::box_grid(4), kind), law, nearly_full<3>));
  }
}

TEST(PhysicsViscous, GradientIsTheDerivativeOfTheFunctional) {
  for (const Law& law : every_law) {
    in_every_geometry(law, [](auto setup) {
      const auto u = setup.rough(1);
      const auto v = setup.rough(7);
      const double h = 1e-5;
      const double difference =
          (setup.value(setup.combination(u, h, v)) - setup.value(setup.combination(u, -h, v))) / (2 * h);
      EXPECT_NEAR(setup.product(setup.gradient(u), v), difference, 1e-7 * (1 + std::abs(difference)));
    });
  }
}

TEST(PhysicsViscous, MatrixIsTheDerivativeOfTheGradientForNewtonianLiquids) {
  in_every_geometry(newtonian, [](auto setup) {
    const auto u = setup.rough(1);
    const auto v = setup.rough(7);
    assemble_matrix(setup.domain, u, dt, Linearisation::secant, setup.work);
    const auto difference = setup.combination(setup.gradient(setup.combination(u, 1, v)), -1, setup.gradient(u));
    EXPECT_LE(setup.size(setup.combination(difference, -1, setup.times_matrix(v))), 1e-12 * setup.size(difference));
  });
}

/// Factors of the tangent, where cells are their own neighbours round an axis, neighbours on both sides, or neither.
template <int Dim>
void expect_solution_round_axis(int axis, int n) {
  SCOPED_TRACE("axis " + std::to_string(axis) + ", " + std::to_string(n) + " cells");
  std::array<std::vector<double>, Dim> faces;
  faces.fill(testing::uniform_axis(Dim == 2 ? 9 : 4));
  faces[static_cast<std::size_t>(axis)] = testing::uniform_axis(n);
  const Grid<Dim> grid(faces, Dim == 2 ? Geometry::planar : Geometry::cartesian);
  Sides<Dim> sides = testing::all_sides(grid, SideKind::no_slip);
  for (int s = 0; s < 2; ++s) sides.at(axis, s).kind = SideKind::periodic;
  Problem<Dim> setup(Domain<Dim>(grid, sides), Papanastasiou{0.1, 0.3, 100}, nearly_full<Dim>);
  const CellVectors<Dim> u = setup.rough(1);
  update_plastic_stress(setup.domain, u, setup.rough(3), setup.work);
  assemble_matrix(setup.domain, u, dt, Linearisation::tangent, setup.work);
  const CellVectors<Dim> b = setup.rough(5);
  CellVectors<Dim> x(setup.domain.layout());
  const SolveReport report = VelocitySolver<Dim>(setup.work.matrix).solve(b, x, 1e-11);
  EXPECT_EQ(report.method, "cholesky");
  EXPECT_LE(setup.size(setup.combination(setup.times_matrix(x), -1, b)), 1e-10 * setup.size(b));
}

TEST(PhysicsViscous, FactorsSolveRoundPeriodicAxes) {
  for (const int n : {1, 2, 3, 17}) {
    for (int axis = 0; axis < 2; ++axis) expect_solution_round_axis<2>(axis, n);
  }
  for (int axis = 0; axis < 3; ++axis) expect_solution_round_axis<3>(axis, 1);
}

TEST(PhysicsViscous, LinearStressWithoutAMatrixIsTheMatrix) {
  in_every_geometry(newtonian, [](auto setup) {
    auto v = setup.rough(7);
    assemble_matrix(setup.domain, v, dt, Linearisation::secant, setup.work);
    const auto expected = setup.times_matrix(v);
    auto y = v;
    apply_linear_stress(setup.domain, v, dt, setup.work, y);
    EXPECT_LE(setup.size(setup.combination(y, -1, expected)), 1e-13 * setup.size(expected));
    auto diagonal = v;
    linear_stress_diagonal(setup.domain, dt, setup.work, diagonal);
    for (std::size_t d = 0; d < v.component.size(); ++d) {
      const int e = static_cast<int>(d);
      EXPECT_LE(testing::largest_difference(setup.domain.grid, diagonal[e], setup.work.matrix.centre(e, e)), 1e-13);
    }
  });
}

TEST(PhysicsViscous, SecantMatrixGivesTheStressItself) {
  // M(u) (u - u^) is the gradient less what u^ itself is strained by: with u^ = 0 the two agree.
  in_every_geometry(bingham, [](auto setup) {
    for (auto& component : setup.u_hat.component) component.fill(0);
    const auto u = setup.rough(1);
    assemble_matrix(setup.domain, u, dt, Linearisation::secant, setup.work);
    const auto g = setup.gradient(u);
    EXPECT_LE(setup.size(setup.combination(g, -1, setup.times_matrix(u))), 1e-12 * setup.size(g));
  });
}

TEST(PhysicsViscous, TangentMatrixIsTheDerivativeOfTheGradientOnceStressAndStrainAgree) {
  for (const Law& law : every_law) {
    in_every_geometry(law, [](auto setup) {
      const auto u = setup.rough(1);
      const auto v = setup.rough(7);
      const auto none = setup.combination(u, -1, u);
      update_plastic_stress(setup.domain, u, none, setup.work);
      assemble_matrix(setup.domain, u, dt, Linearisation::tangent, setup.work);
      const double h = 1e-6;
      auto difference = setup.combination(setup.gradient(setup.combination(u, h, v)), -1,
                                          setup.gradient(setup.combination(u, -h, v)));
      difference = setup.combination(none, 0.5 / h, difference);
      EXPECT_LE(setup.size(setup.combination(difference, -1, setup.times_matrix(v))), 1e-7 * setup.size(difference));
    });
  }
}

TEST(PhysicsViscous, MatricesAreSymmetricAndPositiveDefinite) {
  for (const Linearisation kind : {Linearisation::secant, Linearisation::tangent}) {
    for (const Law& law : every_law) {
      in_every_geometry(law, [kind](auto setup) {
        const auto u = setup.rough(1);
        const auto v = setup.rough(7);
        const auto w = setup.rough(13);
        // A plastic stress that does not agree with the strain, as in the middle of an iteration.
        update_plastic_stress(setup.domain, w, setup.combination(w, 0, w), setup.work);
        assemble_matrix(setup.domain, u, dt, kind, setup.work);
        const double vw = setup.product(v, setup.times_matrix(w));
        EXPECT_NEAR(vw, setup.product(w, setup.times_matrix(v)), 1e-12 * std::abs(vw) + 1e-14);
        EXPECT_GT(setup.product(v, setup.times_matrix(v)), 0);
        EXPECT_GT(setup.product(w, setup.times_matrix(w)), 0);
      });
    }
  }
}

/// Largest component of the gradient at u = u^, that is, of the stress alone, for a ball that touches no side.
template <int Dim, class Velocity>
double stress_of(Domain<Dim> domain, const Vec<Dim>& centre, Velocity&& velocity) {
  Problem<Dim> setup(std::move(domain), bingham, [&](const Domain<Dim>& d, const Species& species) {
    return testing::ball(d, species, centre, 0.3);
  });
  for (int d = 0; d < Dim; ++d) {
    testing::set_cells(setup.domain.grid, setup.u_hat[d], [&](const Vec<Dim>& x) { return velocity(x)[d]; });
  }
  const CellVectors<Dim> g = setup.gradient(setup.u_hat);
  double largest = 0;
  for (int d = 0; d < Dim; ++d) {
    largest = maximum<Cell>(setup.domain.layout(), setup.domain.grid.cells(), largest,
                            [&](Cell c) { return std::abs(g[d][c]) / setup.domain.grid.volume(c); });
  }
  return largest;
}

TEST(PhysicsViscous, RigidMotionsInThePlaneCarryNoStress) {
  const auto domain = [] { return testing::make_domain(testing::stretched_grid(20), SideKind::no_slip); };
  const Vec<2> centre{0.5, 0.5};
  EXPECT_LE(stress_of<2>(domain(), centre, [](const Vec<2>&) { return Vec<2>{1, -2}; }), 1e-11);
  EXPECT_LE(stress_of<2>(domain(), centre, [](const Vec<2>& x) { return Vec<2>{-x[1], x[0]}; }), 1e-11);
  EXPECT_GE(stress_of<2>(domain(), centre, [](const Vec<2>& x) { return Vec<2>{x[1], x[0]}; }), 0.01);
}

TEST(PhysicsViscous, RigidMotionsInSpaceCarryNoStress) {
  const auto domain = [] { return testing::make_domain(testing::box_grid(10), SideKind::no_slip); };
  const Vec<3> centre{0.5, 0.5, 0.5};
  EXPECT_LE(stress_of<3>(domain(), centre, [](const Vec<3>&) { return Vec<3>{1, -2, 3}; }), 1e-11);
  EXPECT_LE(stress_of<3>(domain(), centre,
                         [](const Vec<3>& x) {
                           return Vec<3>{2 * x[2] - x[1], x[0] - 3 * x[2], 3 * x[1] - 2 * x[0]};
                         }),
            1e-11);
}

TEST(PhysicsViscous, MotionAlongTheAxisCarriesNoStress) {
  const auto domain = [] { return testing::make_domain(testing::tank_grid(16), SideKind::no_slip); };
  EXPECT_LE(stress_of<2>(domain(), {0, 0.5}, [](const Vec<2>&) { return Vec<2>{0, 2}; }), 1e-11);
  EXPECT_GE(stress_of<2>(domain(), {0, 0.5}, [](const Vec<2>& x) { return Vec<2>{x[0], 0}; }), 0.01);
}

TEST(PhysicsViscous, IsotropicExpansionCarriesNoStress) {
  // (30) takes the trace off: only changes of shape count.
  const auto domain = testing::make_domain(testing::box_grid(10), SideKind::no_slip);
  EXPECT_LE(stress_of<3>(domain, {0.5, 0.5, 0.5}, [](const Vec<3>& x) { return x; }), 1e-11);
}

TEST(PhysicsViscous, SharesOfTheElementsAddUpToTheLiquid) {
  const auto expect_all = [](auto domain, auto centre) {
    constexpr int Dim = sizeof(centre) / sizeof(double);
    const Problem<Dim> setup(std::move(domain), bingham, [&](const Domain<Dim>& d, const Species& species) {
      return testing::ball<Dim>(d, species, centre, 0.3);
    });
    const StressElements<Dim>& elements = setup.work.elements;
    const Layout<Dim>& layout = setup.domain.layout();
    const double total = sum<Node>(layout, setup.domain.grid.nodes(), [&](Node n) {
      return elements.active[n] ? elements.share[n] * elements.mesh.element(n, layout.multi(n.n)).volume() : 0.0;
    });
    // Elements average the fractions of their corners: equal to the integral up to the weights on stretched or radial
    // axes.
    EXPECT_NEAR(total, testing::integral(setup.domain.grid, setup.mixture.phi[0]), 0.02 * total);
  };
  expect_all(testing::make_domain(testing::planar_grid(20), SideKind::no_slip), Vec<2>{0.5, 0.5});
  expect_all(testing::make_domain(testing::tank_grid(20), SideKind::no_slip), Vec<2>{0, 0.5});
  expect_all(testing::make_domain(testing::box_grid(12), SideKind::no_slip), Vec<3>{0.5, 0.5, 0.5});
}

TEST(PhysicsViscous, WithoutStiffSpeciesNothingIsActive) {
  const auto domain = testing::make_domain(testing::planar_grid(6), SideKind::no_slip);
  Mixture<2> mixture = testing::full(domain, testing::liquid_species(1));
  StressElements<2> elements(domain);
  EXPECT_FALSE(mark_stress_elements(domain, mixture.species, mixture.phi, mixture.total, elements));
}

TEST(PhysicsViscous, RheologyFollowsTheCompositionNotTheFillLevel) {
  const auto domain = testing::make_domain(testing::planar_grid(4), SideKind::no_slip);
  Species sand = testing::liquid_species(2, Papanastasiou{0.1, 0.3, 100});
  sand.concentration = {.viscosity_exponent = 0, .yield_exponent = 4};
  const Species water = testing::liquid_species(1, Newtonian{0.02});
  Mixture<2> mixture(domain, {sand, water});
  testing::set_cells(domain.grid, mixture.phi[0], [](const Vec<2>&) { return 0.3; });
  testing::set_cells(domain.grid, mixture.phi[1], [](const Vec<2>&) { return 0.2; });
  mixture.update();
  StressElements<2> elements(domain);
  ASSERT_TRUE(mark_stress_elements(domain, mixture.species, mixture.phi, mixture.total, elements));
  const Rheology& law = elements.rheology[low_node(domain.grid.cell({2, 2}))];
  EXPECT_NEAR(law.viscosity, 0.6 * 0.1 + 0.4 * 0.02, 1e-14);
  EXPECT_NEAR(law.yield_stress, 0.3 * concentration_factor(4, 0.6), 1e-14);
  EXPECT_NEAR(law.regularization, 100, 1e-12);
}

}  // namespace
}  // namespace quicksand
