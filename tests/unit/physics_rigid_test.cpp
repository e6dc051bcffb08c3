// Bingham's law without regularisation: the duality gap as a bound, rigid plugs, bodies at rest, and the ways to the
// solution.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "physics/rigid_iteration.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

constexpr double dt = 0.01;

/// One viscous step of a mixture.
template <int Dim>
struct Step {
  Domain<Dim> domain;
  Mixture<Dim> mixture;
  DiffusionWork<Dim> work;
  CellVectors<Dim> u_hat, u;
  DiffusionReport report;

  template <class Make>
  Step(Domain<Dim> d, Make&& make)
      : domain(std::move(d)),
        mixture(make(domain)),
        work(domain, mixture.species),
        u_hat(testing::rough_vectors(domain.grid, 3)),
        u(u_hat) {
    mark_stress_elements(domain, mixture.species, mixture.phi, mixture.total, work.elements);
  }
  const DiffusionReport& solve(const DiffusionOptions& options = {}) {
    report = diffuse(domain, mixture.rho, u_hat, dt, options, work, u);
    return report;
  }
  double mass_norm(const CellVectors<Dim>& a, const CellVectors<Dim>& b) const {
    double square = 0;
    for (int d = 0; d < Dim; ++d) {
      square += sum<Cell>(domain.layout(), domain.grid.cells(),
                          [&](Cell c) { return work.mass[d][c] * (a[d][c] - b[d][c]) * (a[d][c] - b[d][c]); });
    }
    return std::sqrt(square);
  }
  double largest_strain() {
    NodeField largest(domain.layout());
    for_each_stress_point(domain, u, work, [&](Node n, const DualElement<Dim>&, int, const StrainRate<Dim>& s) {
      largest[n] = std::max(largest[n], s.scalar);
    });
    return maximum<Node>(domain.layout(), domain.grid.nodes(), 0.0, [&](Node n) { return largest[n]; });
  }
};

/// A ball of one law that touches a wall.
template <int Dim>
auto ball_of(const Law& law) {
  return [law](const Domain<Dim>& d) {
    Vec<Dim> centre;
    for (int e = 0; e < Dim; ++e) centre[e] = e == 0 && d.grid.axisymmetric() ? 0.0 : e == Dim - 1 ? 0.3 : 0.5;
    return testing::ball<Dim>(d, testing::liquid_species(1.3, law), centre, 0.35);
  };
}

/// Calls test(domain maker) in the plane, in the tank and in space.
template <class Test>
void in_every_geometry(Test&& test) {
  {
    SCOPED_TRACE("plane");
    test([] { return testing::make_domain(testing::stretched_grid(12), SideKind::no_slip); });
  }
  {
    SCOPED_TRACE("tank");
    test([] { return testing::make_domain(testing::tank_grid(12), SideKind::no_slip); });
  }
  {
    SCOPED_TRACE("space");
    test([] { return testing::make_domain(testing::box_grid(7), SideKind::no_slip); });
  }
}

template <int Dim>
std::integral_constant<int, Dim> dimension(const Domain<Dim>&);
template <class Make>
constexpr int dim_of = decltype(dimension(std::declval<Make>()()))::value;

TEST(PhysicsRigid, TheRegularizedFlowApproachesItAsAlphaGrows) {
  in_every_geometry([](auto make) {
    constexpr int Dim = dim_of<decltype(make)>;
    Step<Dim> exact(make(), ball_of<Dim>(Bingham{0.02, 15}));
    ASSERT_TRUE(exact.solve({.tolerance = 1e-10}).converged);
    const auto distance = [&](double alpha) {
      Step<Dim> smooth(make(), ball_of<Dim>(Papanastasiou{0.02, 15, alpha}));
      EXPECT_TRUE(smooth.solve({.tolerance = 1e-8}).converged);
      return smooth.mass_norm(smooth.u, exact.u);
    };
    const double coarse = distance(200);
    const double fine = distance(2000);
    EXPECT_LE(fine, 0.15 * coarse);
    EXPECT_GT(fine, 0);
  });
}

TEST(PhysicsRigid, TheGapBoundsTheError) {
  in_every_geometry([](auto make) {
    constexpr int Dim = dim_of<decltype(make)>;
    for (const double viscosity : {0.0, 0.05}) {
      Step<Dim> exact(make(), ball_of<Dim>(Bingham{viscosity, 15}));
      ASSERT_TRUE(exact.solve({.tolerance = 1e-12}).converged);
      for (const double tolerance : {0.1, 1e-2, 1e-4}) {
        Step<Dim> step(make(), ball_of<Dim>(Bingham{viscosity, 15}));
        const DiffusionReport& report = step.solve({.tolerance = tolerance});
        ASSERT_TRUE(report.converged);
        EXPECT_LE(report.gap, tolerance);
        const double error = step.mass_norm(step.u, exact.u);
        const double change = step.mass_norm(step.u, step.u_hat);
        EXPECT_LE(error * error, report.gap * change * change * (1 + 1e-6));
      }
    }
  });
}

TEST(PhysicsRigid, AllMethodsFindTheSameFlow) {
  in_every_geometry([](auto make) {
    constexpr int Dim = dim_of<decltype(make)>;
    for (const double viscosity : {0.0, 0.05}) {
      std::optional<CellVectors<Dim>> first;
      for (const auto kind : {ViscousIteration::newton, ViscousIteration::anderson, ViscousIteration::dual}) {
        Step<Dim> step(make(), ball_of<Dim>(Bingham{viscosity, 15}));
        const DiffusionReport& report = step.solve({.iteration = kind, .tolerance = 1e-5});
        EXPECT_TRUE(report.converged);
        EXPECT_FALSE(report.fell_back);
        EXPECT_LE(report.gap, 1e-5);
        if (!first) first = step.u;
        EXPECT_LE(step.mass_norm(step.u, *first), 6e-3 * step.mass_norm(step.u, step.u_hat));
      }
    }
  });
}

TEST(PhysicsRigid, AStrongBodyMovesRigidlyAndKeepsItsMomentum) {
  const auto flying = [](const Domain<2>& d) {
    return testing::ball<2>(d, testing::liquid_species(1.3, Bingham{0, 1e4}), {0.5, 0.5}, 0.3);
  };
  Step<2> step(testing::make_domain(testing::stretched_grid(14), SideKind::no_slip), flying);
  for (int d = 0; d < 2; ++d) {
    testing::set_cells(step.domain.grid, step.u_hat[d], [&](const Vec<2>& x) { return 1.0 + x[1 - d] * x[d]; });
  }
  step.u = step.u_hat;
  ASSERT_TRUE(step.solve({.tolerance = 1e-8}).converged);
  EXPECT_LE(step.largest_strain(), 1e-8);
  for (int d = 0; d < 2; ++d) {
    const auto momentum = [&](const CellVectors<2>& u) {
      return sum<Cell>(step.domain.layout(), step.domain.grid.cells(),
                       [&](Cell c) { return step.work.mass[d][c] * u[d][c]; });
    };
    EXPECT_NEAR(momentum(step.u), momentum(step.u_hat), 1e-8 * momentum(step.u_hat));
  }
}

TEST(PhysicsRigid, RigidFlightEndsAtOnce) {
  const auto flying = [](const Domain<2>& d) {
    return testing::ball<2>(d, testing::liquid_species(1.3, Bingham{0, 10}), {0.5, 0.5}, 0.3);
  };
  Step<2> step(testing::make_domain(testing::stretched_grid(14), SideKind::no_slip), flying);
  testing::set_cells(step.domain.grid, step.u_hat[0], [](const Vec<2>& x) { return 3 - x[1]; });
  testing::set_cells(step.domain.grid, step.u_hat[1], [](const Vec<2>& x) { return x[0]; });
  step.u = step.u_hat;
  ASSERT_TRUE(step.solve().converged);
  EXPECT_LE(step.report.iterations, 1);
  EXPECT_LE(step.mass_norm(step.u, step.u_hat), 1e-12);
}

/// A layer on the floor, pulled along it.
Step<2> pulled_layer(double pull) {
  Sides<2> sides;
  sides.at(0, 0).kind = sides.at(0, 1).kind = SideKind::open;
  sides.at(1, 0).kind = SideKind::no_slip;
  sides.at(1, 1).kind = SideKind::open;
  const auto layer = [](const Domain<2>& d) {
    Mixture<2> mixture(d, {testing::liquid_species(2, Bingham{0.1, 0.3})});
    testing::set_cells(d.grid, mixture.phi[0], [](const Vec<2>& x) { return x[1] < 0.5 ? 1.0 : 0.0; });
    mixture.update();
    return mixture;
  };
  Step<2> step(Domain<2>(testing::planar_grid(16), sides), layer);
  testing::set_cells(step.domain.grid, step.u_hat[0], [&](const Vec<2>&) { return pull * dt; });
  step.u_hat[1].fill(0);
  step.u = step.u_hat;
  return step;
}

TEST(PhysicsRigid, ABodyBelowItsYieldStressStaysAtRest) {
  // Density 2, height 1/2: the floor holds a pull of up to 0.3 per unit of mass.
  Step<2> step = pulled_layer(0.25);
  for (int k = 0; k < 4; ++k) ASSERT_TRUE(step.solve().converged);
  EXPECT_LE(step.largest_strain(), 1e-15);
  EXPECT_LE(step.report.iterations, 1);
}

TEST(PhysicsRigid, StressesNeverExceedTheYieldStress) {
  Step<2> step = pulled_layer(0.6);
  ASSERT_TRUE(step.solve({.tolerance = 1e-8}).converged);
  EXPECT_GE(step.largest_strain(), 1e-4);
  const double largest = maximum<Node>(step.domain.layout(), step.domain.grid.nodes(), 0.0, [&](Node n) {
    double at_node = 0;
    for (const auto& p : step.work.multiplier[n].at) at_node = std::max(at_node, std::sqrt(inner(p, p)));
    return at_node;
  });
  EXPECT_NEAR(largest, 0.3, 1e-12);
}

TEST(PhysicsRigid, TheDualMethodTakesOverWhenNewtonMayNotIterate) {
  const auto step_with = [](const DiffusionOptions& options) {
    Step<2> step(testing::make_domain(testing::stretched_grid(12), SideKind::no_slip), ball_of<2>(Bingham{0, 15}));
    step.solve(options);
    return step;
  };
  const Step<2> exact = step_with({.tolerance = 1e-8});
  const Step<2> step = step_with({.tolerance = 1e-2, .max_iterations = 1});
  EXPECT_TRUE(step.report.converged);
  EXPECT_TRUE(step.report.fell_back);
  EXPECT_EQ(step.report.method, "dual");
  EXPECT_LE(step.mass_norm(step.u, exact.u), 0.1 * step.mass_norm(step.u, step.u_hat));
}

TEST(PhysicsRigid, WhatDoesNotConvergeSaysSo) {
  Step<2> step(testing::make_domain(testing::stretched_grid(12), SideKind::no_slip), ball_of<2>(Bingham{0, 15}));
  const DiffusionReport& report =
      step.solve({.iteration = ViscousIteration::dual, .tolerance = 1e-16, .max_iterations = 1});
  EXPECT_FALSE(report.converged);
  EXPECT_GT(report.gap, 1e-16);
}

/// Sand below, another species above, and a layer of cells with both.
auto two_layers(const Law& above) {
  return [above](const Domain<2>& d) {
    Mixture<2> mixture(d, {testing::liquid_species(2, Bingham{0.01, 0.4}), testing::liquid_species(1, above)});
    testing::set_cells(d.grid, mixture.phi[0],
                       [](const Vec<2>& x) { return std::clamp((0.52 - x[1]) * 12, 0.0, 1.0); });
    for_each<Cell>(d.layout(), d.grid.cells(), [&](Cell c) { mixture.phi[1][c] = 1 - mixture.phi[0][c]; });
    mixture.update();
    return mixture;
  };
}

TEST(PhysicsRigid, RigidAndSmoothSpeciesShareADomain) {
  for (const Law& above : {Law{Inviscid{}}, Law{Newtonian{0.1}}, Law{Papanastasiou{0.01, 0.1, 50}},
                           Law{HerschelBulkley{0.1, 0.5, 0.1, 50}}, Law{Casson{0.1, 0.1, 50}}}) {
    SCOPED_TRACE(above.index());
    const auto domain = [] { return testing::make_domain(testing::planar_grid(12), SideKind::no_slip); };
    Step<2> step(domain(), two_layers(above));
    ASSERT_TRUE(step.solve({.tolerance = 1e-6}).converged);
    EXPECT_FALSE(step.report.fell_back);
    Step<2> other(domain(), two_layers(above));
    ASSERT_TRUE(other.solve({.iteration = ViscousIteration::dual, .tolerance = 1e-5}).converged);
    EXPECT_LE(step.mass_norm(step.u, other.u), 5e-3 * step.mass_norm(step.u, step.u_hat));
  }
}

}  // namespace
}  // namespace quicksand
