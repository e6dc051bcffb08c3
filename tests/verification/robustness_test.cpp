// Flows that are easy to state and easy to get wrong: rigid motion, films of next to no mass, quantities in SI units.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

/// Largest speed over the cells with more than `least` liquid.
double largest_speed(const Flow<2>& flow, double least) {
  const Grid<2>& grid = flow.domain().grid;
  return std::sqrt(maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) {
    const Vec<2> u = flow.state().u.at(c);
    return flow.total()[c] > least ? u[0] * u[0] + u[1] * u[1] : 0.0;
  }));
}

TEST(Robustness, StiffBodyInRigidMotionKeepsItsVelocity) {
  const CaseConfig config = parse_case(R"(
title: box in flight
units: none
grid: {dimension: 2, geometry: planar, x: {from: 0, to: 1, cells: 32}, z: {from: 0, to: 2, cells: 64}}
boundaries: {x_min: free_slip, x_max: free_slip, z_min: free_slip, z_max: {open: 0}}
gravity: 0
species: [{name: putty, density: 1, rheology: {law: newtonian, viscosity: 100}}]
initial: [{fill: putty, shape: {box: {from: [0.2, 0, 0.2], to: [0.6, 0, 0.8]}}, velocity: [0.3, 0, 0.77]}]
time: {end: 0.5, cfl: 0.3, max_step: 0.01}
)",
                                       "flight");
  Flow<2> flow = build_flow<2>(config);
  const double energy = diagnose(flow).kinetic_energy;
  testing::run(config, flow);
  testing::expect_relative({"stiff body in rigid motion", "kinetic energy", "kept"}, diagnose(flow).kinetic_energy,
                           energy, 1e-12);
  EXPECT_NEAR(largest_speed(flow, 1e-3), std::hypot(0.3, 0.77), 1e-10);
}

TEST(Robustness, FilmsOfNextToNoMassAreNoFasterThanFreeFall) {
  const CaseConfig config = parse_case(R"(
title: sand, water and oil in SI units
grid: {dimension: 2, geometry: axisymmetric, x: {from: 0, to: 1 m, cells: 24}, z: {from: 0, to: 1.5 m, cells: 36}}
boundaries: {x_min: axis, x_max: no_slip, z_min: no_slip, z_max: {open: 1 atm}}
gravity: 9.81
ambient_pressure: 1 atm
species:
  - {name: sand, density: 2000, rheology: {law: papanastasiou, viscosity: 5, yield_stress: 500, regularization: 50}}
  - {name: water, density: 1000, rheology: {law: newtonian, viscosity: 0.001}}
  - {name: oil, density: 800, rheology: {law: newtonian, viscosity: 0.1}}
initial:
  - {fill: sand, shape: {cylinder: {center: [0, 0, 0], radius: 0.4, height: 0.5}}}
  - {fill: water, shape: {cylinder: {center: [0, 0, 0.5], radius: 0.4, height: 0.3}}}
  - {fill: oil, shape: {cylinder: {center: [0, 0, 0.8], radius: 0.4, height: 0.2}}}
time: {end: 0.8, cfl: 0.3, max_step: 0.005}
)",
                                       "three species");
  Flow<2> flow = build_flow<2>(config);
  // A film may fall freely past the liquid; a quotient of round-off errors knows no bound.
  double fastest_liquid = 0;
  double worst = 0;
  testing::run(config, flow, [&](const StepReport&) {
    fastest_liquid = std::max(fastest_liquid, largest_speed(flow, empty_fraction));
    worst = std::max(worst, largest_speed(flow, -1.0) / (fastest_liquid + 9.81 * flow.state().time));
    return true;
  });
  EXPECT_LE(worst, 1);
}

}  // namespace
}  // namespace quicksand
