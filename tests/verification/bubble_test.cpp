// A bubble in the middle of a free disc or ball of liquid against the exact motion, and bubbles at rest.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/cases.hpp"
#include "support/figures.hpp"

namespace quicksand {
namespace {

struct Extreme {
  double radius = 0;
  double time = 0;
};

/// Exact largest radius of a bubble of initial radius 1 and pressure p0, gamma 1.4, in a disc or ball of radius b under
/// the pressure 1, density 1: (R^{D-1} R')' F - (R^{D-1} R')^2 G = P - 1, by the classical Runge-Kutta method.
Extreme exact_maximum(int dimension, double p0, double b) {
  const double shell = std::pow(b, dimension) - 1;
  const auto acceleration = [&](double R, double v) {
    const double outer = std::pow(std::pow(R, dimension) + shell, 1.0 / dimension);
    const double excess = p0 * std::pow(R, -1.4 * dimension) - 1;
    const double q = std::pow(R, dimension - 1) * v;
    const double F = dimension == 2 ? std::log(outer / R) : 1 / R - 1 / outer;
    const int power = 2 * (dimension - 1);
    const double G = 0.5 * (std::pow(R, -power) - std::pow(outer, -power));
    const double q_rate = (excess + q * q * G) / F;
    return (q_rate - (dimension - 1) * std::pow(R, dimension - 2) * v * v) / std::pow(R, dimension - 1);
  };
  constexpr double dt = 1e-3;
  double R = 1;
  double v = 0;
  for (double t = 0;; t += dt) {
    const double k1 = acceleration(R, v);
    const double k2 = acceleration(R + 0.5 * dt * v, v + 0.5 * dt * k1);
    const double k3 = acceleration(R + 0.5 * dt * v + 0.25 * dt * dt * k1, v + 0.5 * dt * k2);
    const double k4 = acceleration(R + dt * v + 0.5 * dt * dt * k2, v + dt * k3);
    const double v_next = v + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (v > 0 && v_next <= 0) {
      const double rest = dt * v / (v - v_next);
      return {R + 0.5 * v * rest, t + rest};
    }
    R += dt * v + dt * dt / 6 * (k1 + k2 + k3);
    v = v_next;
  }
}

TEST(ExactBubble, AgreesWithPublishedFigures) {
  EXPECT_NEAR(exact_maximum(2, 2, 5).radius, 1.604688, 2e-6);
  EXPECT_NEAR(exact_maximum(2, 2, 5).time, 2.835787, 1e-4);
  EXPECT_NEAR(exact_maximum(2, 10, 10).radius, 4.261512, 2e-6);
  EXPECT_NEAR(exact_maximum(2, 10, 10).time, 5.565668, 1e-4);
  EXPECT_NEAR(exact_maximum(3, 10, 1e4).radius, 2.628507, 2e-6);
  EXPECT_NEAR(exact_maximum(3, 10, 1e4).time, 2.869618, 1e-3);
}

/// What a run shows of its bubble.
struct Motion {
  Extreme largest;
  Extreme smallest;  ///< after the largest
};

/// Runs a case of a bubble in the corner of planes of symmetry. \param part  of the whole ball that is modelled
template <int Dim>
Motion observe(const CaseConfig& config, double part) {
  Flow<Dim> flow = build_flow<Dim>(config);
  const Grid<Dim>& grid = flow.domain().grid;
  const bool disc = grid.geometry() == Geometry::planar;
  const auto radius = [&] {
    const double volume = full_circle(grid) * flow.state().gas.bubbles.front().volume / part;
    return disc ? std::sqrt(volume / std::numbers::pi) : std::cbrt(volume * 3 / (4 * std::numbers::pi));
  };
  EXPECT_NEAR(radius(), 1, 1e-6);
  std::vector<Extreme> history{{radius(), 0}};
  testing::run(config, flow, [&](const StepReport& report) {
    EXPECT_TRUE(report.gas.empty());
    if (flow.state().gas.bubbles.size() != 1) return false;
    history.push_back({radius(), flow.state().time});
    return true;
  });
  std::size_t top = 1;
  for (std::size_t i = 1; i + 1 < history.size(); ++i) top = history[i].radius > history[top].radius ? i : top;
  // Vertex of the parabola through the largest value and its neighbours.
  const double x0 = history[top - 1].time - history[top].time;
  const double x2 = history[top + 1].time - history[top].time;
  const double y0 = history[top - 1].radius - history[top].radius;
  const double y2 = history[top + 1].radius - history[top].radius;
  const double a = (y0 / x0 - y2 / x2) / (x0 - x2);
  const double b = y0 / x0 - a * x0;
  Motion motion{{history[top].radius - b * b / (4 * a), history[top].time - b / (2 * a)}, history[top]};
  for (std::size_t i = top; i < history.size(); ++i) {
    if (history[i].radius < motion.smallest.radius) motion.smallest = history[i];
  }
  return motion;
}

/// The shipped disc with another bubble, radius and number of cells.
CaseConfig disc(double p0, double b, int cells_per_radius, double end) {
  CaseConfig config = testing::shipped_case("bubbles/free_disc");
  for (auto* axis : {&config.grid.x, &config.grid.z}) {
    axis->front().to = 1.25 * b;
    axis->front().cells = 5 * cells_per_radius / 4;
  }
  std::get<SphereShape>(config.initial.front().shape).radius = b;
  config.bubbles.front().pressure = p0;
  config.time.end = end;
  return config;
}

const std::string exact_motion = "exact motion";

void expect_close(const std::string& what, const Motion& motion, const Extreme& exact, double radius_error,
                  double time_error) {
  testing::expect_relative({what, "largest radius", exact_motion}, motion.largest.radius, exact.radius, radius_error);
  testing::expect_relative({what, "time of the largest radius", exact_motion}, motion.largest.time, exact.time,
                           time_error);
}

void expect_rebound(const std::string& what, const Motion& motion, double bound) {
  testing::expect_relative({what, "smallest radius at the rebound", exact_motion}, motion.smallest.radius, 1, bound);
}

TEST(FreeBubble, DiscAtTwiceTheAmbientPressure) {
  const Motion motion = observe<2>(disc(2, 5, 32, 6.1), 0.25);
  expect_close("bubble in a disc, P = 2, 32 cells", motion, exact_maximum(2, 2, 5), 0.001, 0.001);
  expect_rebound("bubble in a disc, P = 2, 32 cells", motion, 0.003);
}

TEST(FreeBubble, DiscAtTenTimesTheAmbientPressure) {
  const Extreme exact = exact_maximum(2, 10, 10);
  const Motion coarse = observe<2>(disc(10, 10, 16, 6.5), 0.25);
  const Motion fine = observe<2>(disc(10, 10, 32, 12), 0.25);
  expect_close("bubble in a disc, P = 10, 16 cells", coarse, exact, 0.006, 0.003);
  expect_close("bubble in a disc, P = 10, 32 cells", fine, exact, 0.003, 0.002);
  expect_rebound("bubble in a disc, P = 10, 32 cells", fine, 0.02);
}

TEST(FreeBubble, Ball) {
  const Motion motion = observe<2>(testing::shipped_case("bubbles/free_ball"), 0.5);
  expect_close("bubble in a ball, P = 10, 32 cells", motion, exact_maximum(3, 10, 5), 0.003, 0.002);
  expect_rebound("bubble in a ball, P = 10, 32 cells", motion, 0.02);
}

TEST(FreeBubble, PushesEvenIfItFillsNoCell) {
  // Its cells are a quarter to a half full, so that none is outside D or without pressure by itself.
  CaseConfig config = disc(10, 10, 16, 0.5);
  const double h = config.grid.x.front().to / config.grid.x.front().cells;
  config.boundaries.x_min->kind = config.boundaries.z_min->kind = SideKind::free_slip;
  config.bubbles.front().center = {{3 * h, 0, 3 * h}};
  config.bubbles.front().radius = 0.9 * h;
  Flow<2> flow = build_flow<2>(config);
  ASSERT_EQ(flow.state().gas.bubbles.size(), 1u);
  const double before = flow.state().gas.bubbles.front().volume;
  testing::run(config, flow);
  ASSERT_EQ(flow.state().gas.bubbles.size(), 1u);
  EXPECT_GT(flow.state().gas.bubbles.front().volume, 1.5 * before);
}

CaseConfig octant(int cells_per_radius, double b) {
  CaseConfig config = testing::shipped_case("bubbles/free_ball");
  config.grid.dimension = 3;
  config.grid.geometry = Geometry::planar;
  const AxisSegment axis{0.0, 1.25 * b, 5 * cells_per_radius / 4, Stretch::uniform};
  config.grid.x = config.grid.y = config.grid.z = {axis};
  const SideConfig symmetry{SideKind::symmetry, 0};
  config.boundaries.x_min = config.boundaries.y_min = symmetry;
  config.boundaries.y_max = config.boundaries.x_max;
  std::get<SphereShape>(config.initial.front().shape).radius = b;
  return config;
}

TEST(FreeBubble, OctantOfABall) {
  CaseConfig config = octant(16, 4);
  config.time.end = 2.3;
  expect_close("bubble in a ball in space, P = 10, 16 cells", observe<3>(config, 0.125), exact_maximum(3, 10, 4), 0.006,
               0.003);
}

TEST(FreeBubbleSlow, ReboundAt64Cells) {
  const Extreme exact = exact_maximum(2, 10, 10);
  const Motion plane = observe<2>(disc(10, 10, 64, 12), 0.25);
  expect_close("bubble in a disc, P = 10, 64 cells", plane, exact, 0.002, 0.001);
  expect_rebound("bubble in a disc, P = 10, 64 cells", plane, 0.01);
  EXPECT_NEAR(plane.smallest.time / (2 * exact.time), 1, 0.005);
}

TEST(FreeBubble, AtTheAmbientPressureNothingMoves) {
  CaseConfig config = disc(1, 5, 16, 1);
  Flow<2> flow = build_flow<2>(config);
  testing::run(config, flow);
  EXPECT_LE(diagnose(flow).max_speed, 1e-9);
}

}  // namespace
}  // namespace quicksand
