// Steps that go wrong in any phase: they fail, leave the flow as it was, and are tried again.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/step_retry.hpp"
#include "support/cases.hpp"
#include "support/memory_archive.hpp"

namespace quicksand {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double dt = 2e-3;

Flow<2> moving_flow(const std::string& name = "slug/case_e") {
  Flow<2> flow = build_flow<2>(testing::shipped_case(name));
  for (int n = 0; n < 5; ++n) flow.advance(dt);
  return flow;
}

/// A cell in the middle of the slug.
Cell inside(const Flow<2>& flow) { return flow.domain().grid.cell({{3, 10}}); }

/// Spoils what a part of the step hands on.
struct Fault {
  const char* name;
  int part;
  void (*spoil)(StepInProgress<2>, Cell);
};

const Fault faults[] = {
    {"predicted velocities", 1, [](StepInProgress<2> s, Cell c) { (*s.u_mac)[1][low_face(c)] = nan; }},
    {"projected velocities", 2, [](StepInProgress<2> s, Cell c) { (*s.u_mac)[1][low_face(c)] = nan; }},
    {"convected fractions", 3, [](StepInProgress<2> s, Cell c) { s.next.phi[0][c] = nan; }},
    {"convected momentum", 3, [](StepInProgress<2> s, Cell c) { s.momentum_tilde[0][c] = nan; }},
    {"infinite momentum", 3, [](StepInProgress<2> s, Cell c) { s.momentum_tilde[1][c] = -INFINITY; }},
    {"redistributed fractions", 4, [](StepInProgress<2> s, Cell c) { s.next.phi[0][c] = nan; }},
    {"lost volume", 4, [](StepInProgress<2> s, Cell c) { s.next.phi[0][c] -= 1e-4; }},
    {"redistributed velocities", 5, [](StepInProgress<2> s, Cell c) { s.u_bar[0][c] = nan; }},
    {"raised energy", 5, [](StepInProgress<2> s, Cell c) { s.u_bar[0][c] += 10; }},
    {"diffused velocities", 6, [](StepInProgress<2> s, Cell c) { s.next.u[1][c] = nan; }},
    {"velocities of the end", 7, [](StepInProgress<2> s, Cell c) { s.next.u[1][c] = INFINITY; }},
    {"pressure", 7, [](StepInProgress<2> s, Cell c) { s.next.pressure[low_node(c)] = nan; }},
};

/// A watcher that spoils as many steps as told.
PhaseWatcher<2> spoiler(const Fault& fault, Cell c, int& left) {
  return [fault, c, &left](StepInProgress<2> step) {
    if (step.part != fault.part || left == 0) return;
    --left;
    fault.spoil(step, c);
  };
}

TEST(StepGuard, FaultInAnyPhaseFailsTheStepAndLeavesTheState) {
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.name);
    Flow<2> flow = moving_flow();
    State<2> before = flow.state();
    CellField total = flow.total();
    CellField density = flow.density();
    CellMask liquid = flow.liquid();
    int left = 1;
    flow.watch(spoiler(fault, inside(flow), left));
    EXPECT_THROW(flow.advance(dt), NumericalError);
    EXPECT_EQ(left, 0);
    EXPECT_EQ(flow.state().step, before.step);
    ASSERT_NE(flow.failed_attempt(), nullptr);
    EXPECT_EQ(flow.failed_attempt()->step, before.step + 1);
    State<2> after = flow.state();
    EXPECT_EQ(after.phi[0].values(), before.phi[0].values());
    EXPECT_EQ(after.pressure.values(), before.pressure.values());
    EXPECT_EQ(CellField(flow.total()).values(), total.values());
    EXPECT_EQ(CellField(flow.density()).values(), density.values());
    EXPECT_EQ(CellMask(flow.liquid()).values(), liquid.values());
    const State<2>& attempt = *flow.failed_attempt();
    for (int d = 0; d < 2; ++d) {
      EXPECT_EQ(after.u[d].values(), before.u[d].values());
      EXPECT_EQ(after.acceleration[d].values(), before.acceleration[d].values());
      EXPECT_EQ(attempt.u[d].size(), total.size());
      EXPECT_EQ(attempt.acceleration[d].size(), total.size());
    }
    EXPECT_EQ(attempt.phi[0].size(), total.size());
    EXPECT_EQ(attempt.pressure.size(), total.size());
    const StepReport report = flow.advance(dt);
    EXPECT_TRUE(std::isfinite(report.momentum_norm));
    EXPECT_EQ(flow.state().step, before.step + 1);
  }
}

TEST(StepGuard, FailedStepsAreTriedAgainWithHalfTheStep) {
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.name);
    Flow<2> flow = moving_flow();
    int left = 2;
    flow.watch(spoiler(fault, inside(flow), left));
    std::vector<std::string> said;
    const auto say = [&](const std::string& text) { said.push_back(text); };
    advance_with_retries(flow, dt, {.halvings = 8, .least_step = 0}, say);
    EXPECT_EQ(said.size(), 2u);
    EXPECT_DOUBLE_EQ(flow.state().dt, dt / 4);

    left = 1000;
    said.clear();
    const double time = flow.state().time;
    EXPECT_THROW(advance_with_retries(flow, dt, {.halvings = 3, .least_step = 0}, say), NumericalError);
    EXPECT_EQ(said.size(), 3u);
    EXPECT_THROW(advance_with_retries(flow, dt, {.halvings = 8, .least_step = 0.3 * dt}, say), NumericalError);
    EXPECT_EQ(flow.state().time, time);
  }
}

TEST(StepGuard, StressesOfBinghamsLawOutliveAFailedStep) {
  Flow<2> flow = moving_flow("slug/case_e_bingham");
  auto stress = flow.rigid_stress();
  const double penalty = flow.rigid_viscosity();
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.name);
    int left = 1;
    flow.watch(spoiler(fault, inside(flow), left));
    EXPECT_THROW(flow.advance(dt), NumericalError);
    EXPECT_EQ(flow.rigid_viscosity(), penalty);
    for_each<Node>(flow.domain().layout(), flow.domain().grid.nodes(), [&](Node n) {
      EXPECT_EQ(inner(flow.rigid_stress()[n].at[0], flow.rigid_stress()[n].at[0]),
                inner(stress[n].at[0], stress[n].at[0]));
    });
  }
}

TEST(StepGuard, BoundsNameWhatIsBroken) {
  std::vector<Species> species(2);
  species[0].name = "sand";
  species[1].name = "water";
  const GuardSettings guard;
  const auto message = [&](const StepBalance& balance) -> std::string {
    try {
      check_balance(balance, species, guard);
    } catch (const NumericalError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({{1, 2}, {1, 2 + 1e-10}, 3, 1e-8, 1e-8, 1}), "");
  EXPECT_NE(message({{1, 2}, {1, 2.1}, 3, 0, 0, 1}).find("volume of water"), std::string::npos);
  EXPECT_NE(message({{1, 2}, {1, 2}, 3, 1e-3, 0, 1}).find("redistribution raised"), std::string::npos);
  EXPECT_NE(message({{1, 2}, {1, 2}, 3, 0, 1e-3, 1}).find("projection raised"), std::string::npos);
  // A domain that began empty and is filled through a side: what has escaped is negative.
  EXPECT_EQ(message({{0, 0}, {0, 1e-13}, 3, 0, 0, 1}), "");
}

}  // namespace
}  // namespace quicksand
