// Decay of shear waves by one implicit step. A wave u with div T = -lambda mu u shrinks by 1 / (1 + dt lambda mu /
// rho): what is left of the error is that of the stress operator, second order in the cell width.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/diffusion.hpp"
#include "support/figures.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using std::numbers::pi;
using testing::Mixture;

constexpr double viscosity = 0.8;
constexpr double density = 1.6;
constexpr double dt = 0.3;

/// Largest error of a wave after one step, relative to the wave's exact amplitude.
/// \param component  the only velocity component
/// \param wave       x -> velocity, an eigenfunction of the stress
/// \param lambda     its eigenvalue
template <int Dim, class Wave>
double wave_error(const Domain<Dim>& domain, int component, double lambda, Wave&& wave) {
  const Grid<Dim>& grid = domain.grid;
  Mixture<Dim> mixture = testing::full(domain, testing::liquid_species(density, Newtonian{viscosity}));
  DiffusionWork<Dim> work(domain, mixture.species);
  mark_stress_elements(domain, mixture.species, mixture.phi, mixture.total, work.elements);
  CellVectors<Dim> u_hat(domain.layout());
  testing::set_cells(grid, u_hat[component], wave);
  CellVectors<Dim> u = u_hat;
  const DiffusionReport report = diffuse(domain, mixture.rho, u_hat, dt, {.tolerance = 1e-10}, work, u);
  EXPECT_TRUE(report.converged);
  const double decay = 1 / (1 + dt * lambda * viscosity / density);
  double error = 0;
  for (int d = 0; d < Dim; ++d) {
    error = std::max(error, maximum<Cell>(domain.layout(), grid.cells(), 0.0,
                                          [&](Cell c) { return std::abs(u[d][c] - decay * u_hat[d][c]); }));
  }
  return error / decay;
}

/// Expects errors that fall to second order from n to 2n cells and end below `bound`.
template <class Error>
void expect_second_order(const std::string& what, Error&& error, int n, double bound) {
  const double coarse = error(n);
  const double fine = error(2 * n);
  const std::string with_cells = what + ", " + std::to_string(2 * n) + " cells";
  testing::expect_at_most({with_cells, "error of the velocity", "exact decay"}, fine, bound);
  testing::expect_order({with_cells, "error of the velocity", "exact decay"}, coarse, fine, 1.8);
}

/// Sides that let the flow pass along one axis, and walls of one kind on the others.
template <int Dim>
Domain<Dim> channel(Grid<Dim> grid, int along, SideKind walls) {
  Sides<Dim> sides = testing::all_sides(grid, walls);
  for (int s = 0; s < 2; ++s) sides.at(along, s).kind = SideKind::open;
  return Domain<Dim>(std::move(grid), sides);
}

TEST(DiffusionConvergence, ShearWaveBetweenFreeSides) {
  const auto error = [](int n) {
    return wave_error(channel(testing::planar_grid(n), 0, SideKind::free_slip), 0, pi * pi,
                      [](const Vec<2>& x) { return std::cos(pi * x[1]); });
  };
  expect_second_order("shear wave between free sides", error, 16, 2e-3);
}

TEST(DiffusionConvergence, ShearWaveBetweenWallsThatHoldIt) {
  const auto error = [](int n) {
    return wave_error(channel(testing::planar_grid(n), 0, SideKind::no_slip), 0, pi * pi,
                      [](const Vec<2>& x) { return std::sin(pi * x[1]); });
  };
  expect_second_order("shear wave between walls", error, 16, 2e-3);
}

TEST(DiffusionConvergence, ShearWaveOnAStretchedAxis) {
  const auto error = [](int n) {
    const Grid<2> grid({testing::uniform_axis(4), testing::graded_axis(n, 0, 1, 3)}, Geometry::planar);
    return wave_error(channel(grid, 0, SideKind::no_slip), 0, pi * pi,
                      [](const Vec<2>& x) { return std::sin(pi * x[1]); });
  };
  expect_second_order("shear wave on a graded axis", error, 32, 2e-4);
}

TEST(DiffusionConvergence, PipeFlowThatSlipsAtTheWall) {
  constexpr double zero_of_J1 = 3.8317059702075123;
  const auto error = [](int n) {
    return wave_error(channel(testing::tank_grid(n), 1, SideKind::free_slip), 1, zero_of_J1 * zero_of_J1,
                      [](const Vec<2>& x) { return std::cyl_bessel_j(0.0, zero_of_J1 * x[0]); });
  };
  expect_second_order("pipe, slip", error, 16, 5e-3);
}

TEST(DiffusionConvergence, PipeFlowThatSticksToTheWall) {
  constexpr double zero_of_J0 = 2.4048255576957728;
  const auto error = [](int n) {
    return wave_error(channel(testing::tank_grid(n), 1, SideKind::no_slip), 1, zero_of_J0 * zero_of_J0,
                      [](const Vec<2>& x) { return std::cyl_bessel_j(0.0, zero_of_J0 * x[0]); });
  };
  expect_second_order("pipe, no slip", error, 16, 5e-3);
}

TEST(DiffusionConvergence, DuctFlowInSpace) {
  const auto error = [](int n) {
    const Grid<3> grid({testing::uniform_axis(2), testing::uniform_axis(n), testing::uniform_axis(n)},
                       Geometry::cartesian);
    return wave_error(channel(grid, 0, SideKind::no_slip), 0, 2 * pi * pi,
                      [](const Vec<3>& x) { return std::sin(pi * x[1]) * std::sin(pi * x[2]); });
  };
  expect_second_order("duct in space", error, 8, 1e-2);
}

TEST(DiffusionConvergence, AllIterationsFindTheSameFlow) {
  const auto domain = testing::make_domain(testing::planar_grid(12), SideKind::no_slip);
  Mixture<2> mixture =
      testing::ball<2>(domain, testing::liquid_species(1, Papanastasiou{0.01, 0.2, 50}), {0.5, 0.3}, 0.35);
  const CellVectors<2> u_hat = testing::rough_vectors(domain.grid, 1);
  std::vector<CellVectors<2>> found;
  for (const ViscousIteration kind : {ViscousIteration::newton, ViscousIteration::anderson, ViscousIteration::picard}) {
    DiffusionWork<2> work(domain, mixture.species);
    mark_stress_elements(domain, mixture.species, mixture.phi, mixture.total, work.elements);
    CellVectors<2> u = u_hat;
    const DiffusionReport report =
        diffuse(domain, mixture.rho, u_hat, 0.01, {.iteration = kind, .tolerance = 1e-7}, work, u);
    EXPECT_TRUE(report.converged);
    EXPECT_FALSE(report.fell_back);
    EXPECT_LE(report.residual, 1e-7);
    found.push_back(u);
  }
  for (int d = 0; d < 2; ++d) {
    EXPECT_LE(testing::largest_difference(domain.grid, found[0][d], found[1][d]), 1e-5);
    EXPECT_LE(testing::largest_difference(domain.grid, found[0][d], found[2][d]), 1e-5);
  }
}

}  // namespace
}  // namespace quicksand
