// The two projections: nodal pressure (50)-(52), and the face velocities.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/energy.hpp"
#include "physics/mac_projection.hpp"
#include "physics/projection.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using std::numbers::pi;
using testing::Mixture;

constexpr double dt = 0.1;
const SolveOptions sharp{{.relative = 1e-12, .max_iterations = 500}, Method::automatic};

template <int Dim>
NodeField project(const Mixture<Dim>& mixture, double gas_pressure, CellVectors<Dim>& u) {
  ProjectionWork<Dim> work(mixture.domain.layout());
  NodeField pressure(mixture.domain.layout(), gas_pressure);
  solve_pressure(mixture.domain, Projected::velocity, 0.0, u, mixture.rho, mixture.elements, dt, sharp, work, pressure);
  add_pressure_gradient(mixture.domain, pressure, mixture.rho, mixture.elements, -dt, u);
  return pressure;
}

/// Layers of density 2 and 1 up to z = 1/4 and 1/2, falling freely for one step.
template <int Dim>
void expect_hydrostatic(const Domain<Dim>& domain) {
  constexpr int up = Dim - 1;
  Mixture<Dim> mixture(domain, {testing::liquid_species(2), testing::liquid_species(1)});
  testing::set_cells(domain.grid, mixture.phi[0], [](const Vec<Dim>& x) { return x[up] < 0.25 ? 1.0 : 0.0; });
  testing::set_cells(domain.grid, mixture.phi[1],
                     [](const Vec<Dim>& x) { return x[up] > 0.25 && x[up] < 0.5 ? 1.0 : 0.0; });
  mixture.update();
  CellVectors<Dim> u(domain.layout());
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) { u[up][c] = -dt * 3.0; });
  const NodeField pressure = project(mixture, 0.7, u);
  for_each<Node>(domain.layout(), domain.grid.nodes(), [&](Node n, const Index<Dim>& i) {
    const double z = domain.grid.face_position(up, i[up]);
    const double head = z < 0.25 ? 0.25 + 2 * (0.25 - z) : std::max(0.5 - z, 0.0);
    EXPECT_NEAR(pressure[n], 0.7 + 3.0 * head, 1e-10);
  });
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) {
    for (int d = 0; d < Dim; ++d) EXPECT_NEAR(u[d][c], mixture.liquid[c] || d != up ? 0.0 : -dt * 3.0, 1e-11);
  });
}

TEST(PhysicsProjection, HydrostaticPressureIsExact) {
  expect_hydrostatic(testing::make_domain(testing::planar_grid(16), SideKind::no_slip));
  expect_hydrostatic(testing::make_domain(testing::tank_grid(16), SideKind::no_slip));
  expect_hydrostatic(testing::make_domain(testing::box_grid(8), SideKind::no_slip));
  const Grid<2> stretched({testing::graded_axis(9, 0, 1, 4), testing::graded_axis(16, 0, 1, 1)},
                          Geometry::axisymmetric);
  expect_hydrostatic(testing::make_domain(stretched, SideKind::no_slip));
}

template <int Dim>
void expect_energy_falls(const Mixture<Dim>& mixture) {
  const Grid<Dim>& grid = mixture.domain.grid;
  for (const double seed : {1.0, 2.0, 3.0}) {
    CellVectors<Dim> u = testing::rough_vectors(grid, seed);
    const double before = kinetic_energy(grid, mixture.rho, u);
    project(mixture, 0.7, u);
    const double after = kinetic_energy(grid, mixture.rho, u);
    EXPECT_LE(after, before * (1 + 1e-12));
    EXPECT_LT(after, 0.98 * before);
  }
}

TEST(PhysicsProjection, KineticEnergyNeverRises) {
  const Species liquid = testing::liquid_species(1.7);
  const auto plane = testing::make_domain(testing::stretched_grid(20), SideKind::no_slip);
  const auto tank = testing::make_domain(testing::tank_grid(20), SideKind::open);
  const auto box = testing::make_domain(testing::box_grid(10), SideKind::free_slip);
  expect_energy_falls(testing::ball<2>(plane, liquid, {0.4, 0.5}, 0.3));
  expect_energy_falls(testing::ball<2>(tank, liquid, {0, 0.2}, 0.5));
  expect_energy_falls(testing::ball<3>(box, liquid, {0.4, 0.1, 0.5}, 0.4));
  expect_energy_falls(testing::full(plane, liquid));
}

TEST(PhysicsProjection, UniformGasPressureDoesNotMatter) {
  const auto domain = testing::make_domain(testing::planar_grid(16), SideKind::no_slip);
  const Mixture<2> mixture = testing::ball<2>(domain, testing::liquid_species(1), {0.5, 0.5}, 0.3);
  CellVectors<2> low = testing::rough_vectors(domain.grid, 1);
  CellVectors<2> high = low;
  project(mixture, 0, low);
  project(mixture, 100, high);
  for (int d = 0; d < 2; ++d) EXPECT_LE(testing::largest_difference(domain.grid, low[d], high[d]), 1e-9);
}

/// Largest error with which the projection of a swirl and a gradient in a closed box returns the swirl.
double swirl_error(int n) {
  const auto domain = testing::make_domain(testing::planar_grid(n), SideKind::free_slip);
  const Mixture<2> mixture = testing::full(domain, testing::liquid_species(1));
  CellVectors<2> u(domain.layout()), swirl(domain.layout());
  const auto set = [&](CellField& field, auto&& f) { testing::set_cells(domain.grid, field, f); };
  set(swirl[0], [](const Vec<2>& x) { return std::sin(pi * x[0]) * std::cos(pi * x[1]); });
  set(swirl[1], [](const Vec<2>& x) { return -std::cos(pi * x[0]) * std::sin(pi * x[1]); });
  set(u[0], [](const Vec<2>& x) { return std::sin(pi * x[0]) * (std::cos(pi * x[1]) + std::cos(2 * pi * x[1])); });
  set(u[1], [](const Vec<2>& x) {
    return -std::cos(pi * x[0]) * std::sin(pi * x[1]) + 2 * std::cos(pi * x[0]) * std::sin(2 * pi * x[1]);
  });
  project(mixture, 0, u);
  return std::max(testing::largest_difference(domain.grid, u[0], swirl[0]),
                  testing::largest_difference(domain.grid, u[1], swirl[1]));
}

TEST(PhysicsProjection, SeparatesSwirlFromGradientToSecondOrder) {
  const double coarse = swirl_error(16);
  const double fine = swirl_error(32);
  EXPECT_LE(fine, 0.01);
  EXPECT_GE(std::log2(coarse / fine), 1.8);
}

/// Largest divergence of the face velocities over the cells of D, times the cell width.
template <int Dim>
double divergence(const Mixture<Dim>& mixture, const FaceScalars<Dim>& u) {
  const Domain<Dim>& domain = mixture.domain;
  return maximum<Cell>(domain.layout(), domain.grid.cells(), 0.0, [&](Cell c, const Index<Dim>& i) {
    double out = 0;
    for (int d = 0; d < Dim; ++d) {
      const Face above = low_face(c + domain.grid.step(d));
      out += domain.aperture(d, shifted(i, d, 1)) * u[d][above] - domain.aperture(d, i) * u[d][low_face(c)];
    }
    return mixture.liquid[c] ? std::abs(out) / domain.grid.volume(c) * domain.grid.smallest_width() : 0.0;
  });
}

template <int Dim>
FaceScalars<Dim> rough_faces(const Domain<Dim>& domain) {
  FaceScalars<Dim> u(domain.layout());
  for (int d = 0; d < Dim; ++d) {
    for_each<Face>(domain.layout(), domain.grid.faces(d),
                   [&](Face f, const Index<Dim>& i) { u[d][f] = domain.passes(d, i) ? testing::rough(i, d) : 0.0; });
  }
  return u;
}

template <int Dim>
void expect_no_divergence(const Mixture<Dim>& mixture) {
  FaceScalars<Dim> u = rough_faces(mixture.domain);
  ASSERT_GT(divergence(mixture, u), 0.1);
  CellField potential(mixture.domain.layout());
  project_face_velocities(mixture.domain, mixture.rho, mixture.liquid, CellField(mixture.domain.layout()), sharp,
                          potential, u);
  EXPECT_LE(divergence(mixture, u), 1e-9);
  for (int d = 0; d < Dim; ++d) {
    for_each<Face>(mixture.domain.layout(), mixture.domain.grid.faces(d), [&](Face f, const Index<Dim>& i) {
      if (mixture.domain.aperture(d, i) == 0) {
        EXPECT_EQ(u[d][f], 0);
      }
    });
  }
}

TEST(PhysicsMacProjection, FaceVelocitiesInTheLiquidLoseTheirDivergence) {
  const Species liquid = testing::liquid_species(1.7);
  const auto plane = testing::make_domain(testing::stretched_grid(20), SideKind::no_slip);
  const auto tank = testing::make_domain(testing::tank_grid(20), SideKind::open);
  const auto box = testing::make_domain(testing::box_grid(10), SideKind::free_slip);
  expect_no_divergence(testing::ball<2>(plane, liquid, {0.4, 0.5}, 0.3));
  expect_no_divergence(testing::ball<2>(tank, liquid, {0, 0.2}, 0.5));
  expect_no_divergence(testing::ball<3>(box, liquid, {0.4, 0.1, 0.5}, 0.4));
  expect_no_divergence(testing::full(plane, liquid));
}

TEST(PhysicsMacProjection, LiquidBeyondAnOpenSideBoundsNothing) {
  const Grid<2> grid = testing::stretched_grid(20);
  for (const int side : {0, 1}) {
    SCOPED_TRACE(side);
    Sides<2> sides = testing::all_sides(grid, SideKind::no_slip);
    sides.at(0, side).kind = SideKind::open;
    sides.at(0, side).outside = 0;
    const Domain<2> domain(grid, sides);
    expect_no_divergence(testing::full(domain, testing::liquid_species(1.7)));
  }
}

TEST(PhysicsMacProjection, FacesBetweenGasCellsAreLeftAlone) {
  const auto domain = testing::make_domain(testing::planar_grid(16), SideKind::no_slip);
  const Mixture<2> mixture = testing::ball<2>(domain, testing::liquid_species(1), {0.5, 0.5}, 0.3);
  const FaceScalars<2> before = rough_faces(domain);
  FaceScalars<2> after = before;
  CellField potential(domain.layout());
  project_face_velocities(domain, mixture.rho, mixture.liquid, CellField(domain.layout()), sharp, potential, after);
  for (int d = 0; d < 2; ++d) {
    for_each<Face>(domain.layout(), domain.grid.faces(d), [&](Face f) {
      const Cell high = high_cell(f);
      if (!mixture.liquid[high] && !mixture.liquid[high - domain.grid.step(d)]) {
        EXPECT_EQ(after[d][f], before[d][f]);
      }
    });
  }
}

}  // namespace
}  // namespace quicksand
