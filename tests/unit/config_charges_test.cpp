// Charges in case files: what they become, and every mistake with its place.
#include <gtest/gtest.h>

#include "app/build_flow.hpp"
#include "app/case_report.hpp"
#include "app/case_warnings.hpp"
#include "app/initial_bubbles.hpp"
#include "config_test_case.hpp"

namespace quicksand {
namespace {

/// The report's charge, buried an inch deep in sand under 2.5 in of water; the charge stands in line 29.
const std::string planar_case = R"(title: A charge
grid:
  dimension: 2
  x: {from: 0, to: 10 in, cells: 20}
  z: {from: -6 in, to: 4 in, cells: 20}
boundaries:
  x_min: symmetry
  x_max: no_slip
  z_min: no_slip
  z_max: {open: 33.9 ftH2O}
gravity: 9.80665
ambient_pressure: 33.9 ftH2O
species:
  - name: sand
    density: 2000
    rheology: {law: inviscid}
  - name: water
    density: 1000
    rheology: {law: inviscid}
initial:
  - fill: sand
    shape: {box: {from: [0, -6 in], to: [10 in, -2.5 in]}}
  - fill: water
    shape: {layer: {bottom: -2.5 in, top: 0}}
time: {end: 1 ms, step: 0.1 ms}
output:
  directory: results/test
charges:
  - {center: [0, -3.5 in], mass: 0.203 g, radius_constant: 11, minimum_radius_constant: 0.272, adiabatic_exponent: 1.3, thickness: 2 in}
)";

std::string ball(std::string text) {
  text = with("dimension: 2", "dimension: 2\n  geometry: axisymmetric", text);
  return with(", thickness: 2 in", "", with("x_min: symmetry", "x_min: axis", text));
}

PlacedCharge placed(const std::string& text, const std::vector<std::string>& settings = {}) {
  const CaseConfig config = parse_case(text, "case.yaml", settings);
  return place_charge(config, config.charges.at(0));
}

constexpr double inch = 0.0254;

TEST(ConfigCharges, ThePressureAroundThemIsThatOfTheWaterAbove) {
  const PlacedCharge charge = placed(planar_case);
  EXPECT_NEAR(charge.depth, 3.5 * inch, 1e-8);
  EXPECT_EQ(charge.density, 1000) << "the topmost liquid, not the sand around the charge";
  EXPECT_NEAR(charge.p_inf / traditional::foot_of_water, 33.9 + 3.5 / 12, 1e-7);
  EXPECT_NEAR(charge.bubble.radius_ratio, 41.567, 5e-4);
  EXPECT_NEAR(charge.bubble.minimum_radius, 0.10186 * inch, 5e-6 * inch);
  EXPECT_NEAR(placed(ball(planar_case)).bubble.radius_ratio, 12.00, 5e-3);
}

TEST(ConfigCharges, TheSurfaceIsThatOfTheLiquidRightAbove) {
  // A layer higher up, with air between, does not press on the charge; without gravity nothing does.
  const std::string roof =
      with("time:", "  - fill: sand\n    shape: {layer: {bottom: 1 in, top: 2 in}}\ntime:", planar_case);
  EXPECT_NEAR(placed(roof).depth, 3.5 * inch, 1e-8);
  EXPECT_NEAR(placed(planar_case, {"gravity=0"}).p_inf, 33.9 * traditional::foot_of_water, 1e-6);
}

TEST(ConfigCharges, OpenTopUnderLiquidGivesItsPressure) {
  const PlacedCharge charge = placed(planar_case, {"initial.1.shape={layer: {bottom: -2.5 in, top: 4 in}}",
                                                   "boundaries.z_max={open: 3 atm, outside: water}"});
  EXPECT_NEAR(charge.depth, 7.5 * inch, 1e-12);
  EXPECT_NEAR(charge.p_inf, 3 * 101325 + 1000 * 9.80665 * 7.5 * inch, 1e-3);
}

TEST(ConfigCharges, BecomeBubbles) {
  CaseConfig config = parse_case(planar_case, "case.yaml");
  config.bubbles.push_back({Vec<3>{{5 * inch, 0, -3 * inch}}, inch, 2e5, 1.4});
  const std::vector<InitialBubble> bubbles = initial_bubbles(config);
  ASSERT_EQ(bubbles.size(), 2u);
  EXPECT_EQ(bubbles[0].pressure, 2e5);
  EXPECT_EQ(bubbles[1].center, config.charges[0].center);
  EXPECT_NEAR(bubbles[1].pressure / placed(planar_case).p_inf, 580.03, 5e-3);
  EXPECT_EQ(bubbles[1].adiabatic_exponent, 1.3);
}

TEST(ConfigCharges, StartTheFlowWithTheirGas) {
  // Cells of 0.025 in: the gas fills half a disc.
  const std::vector<std::string> fine = {
      "grid.x={from: 0, to: 0.5 in, cells: 20}", "grid.z={from: -4 in, to: -3 in, cells: 40}",
      "boundaries.z_max={open: 33.9 ftH2O}", "initial=[{fill: water, shape: {layer: {bottom: -4 in, top: -3 in}}}]"};
  const CaseConfig config = parse_case(planar_case, "case.yaml", fine);
  const PlacedCharge charge = place_charge(config, config.charges[0]);
  const Flow<2> flow = build_flow<2>(config);
  ASSERT_EQ(flow.state().gas.bubbles.size(), 1u);
  const Bubble& bubble = flow.state().gas.bubbles[0];
  EXPECT_EQ(bubble.exponent, 1.3);
  EXPECT_NEAR(bubble.pressure / charge.bubble.initial_pressure, 1, 1e-12);
  EXPECT_NEAR(bubble.volume / (M_PI / 2 * std::pow(charge.bubble.minimum_radius, 2)), 1, 1e-10);
}

TEST(ConfigCharges, StartWithTheVolumeOfTheirBall) {
  // Four to five cells per radius of 0.25 in, on stretched axes.
  const std::vector<std::string> fine = {
      "grid.x=[{from: 0, to: 0.4 in, cells: 7}, {to: 1 in, cells: 5, stretch: smooth}]",
      "grid.z=[{from: -4.5 in, to: -3.8 in, cells: 5, stretch: smooth}, {to: -3.1 in, cells: 12}]",
      "initial=[{fill: water, shape: {layer: {bottom: -4.5 in, top: -3.1 in}}}]"};
  const CaseConfig turned = parse_case(ball(planar_case), "case.yaml", fine);
  const double radius = place_charge(turned, turned.charges[0]).bubble.minimum_radius;
  const double volume = 4 * M_PI / 3 * std::pow(radius, 3);
  EXPECT_NEAR(2 * M_PI * build_flow<2>(turned).state().gas.bubbles.at(0).volume / volume, 1, 1e-10);

  std::string space =
      with("dimension: 2\n", "dimension: 3\n  y: {from: -0.5 in, to: 0.5 in, cells: 18}\n", planar_case);
  space = with("x_max: no_slip", "x_max: no_slip\n  y_min: no_slip\n  y_max: no_slip",
               with(", thickness: 2 in", "", space));
  space = with("[0, -3.5 in]", "[0, 0.01 in, -3.5 in]", space);
  const CaseConfig half = parse_case(space, "case.yaml", fine);
  EXPECT_NEAR(2 * build_flow<3>(half).state().gas.bubbles.at(0).volume / volume, 1, 1e-10);
}

TEST(ConfigCharges, AreReported) {
  const std::string planar = case_report(parse_case(planar_case, "case.yaml"));
  for (const std::string part : {"depth 0.0889", "P_inf 1.022e+05", "radius ratio 41.567", "A_min 0.0025872",
                                 "A_max 0.10754", "580.03 P_inf", "free-field period none"}) {
    EXPECT_NE(planar.find(part), std::string::npos) << part << "\n" << planar;
  }
  const std::string axisymmetric = case_report(parse_case(ball(planar_case), "case.yaml"));
  EXPECT_NE(axisymmetric.find("radius ratio 12\n"), std::string::npos) << axisymmetric;
  EXPECT_NE(axisymmetric.find("free-field period 0.0"), std::string::npos) << axisymmetric;
  const CaseWarnings warnings = case_warnings(parse_case(planar_case, "case.yaml"));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].path, "charges[0]");
  EXPECT_NE(warnings[0].message.find("the minimum radius 0.002587 is 0.2037 cells, less than one"), std::string::npos)
      << warnings[0].message;
}

TEST(ConfigCharges, ReadBackAsTheyAreWritten) {
  const std::string text = to_yaml(parse_case(planar_case, "case.yaml"));
  EXPECT_EQ(to_yaml(parse_case(text, "again")), text);
  EXPECT_NE(case_schema().find("minimum_radius_constant"), std::string::npos);
}

struct Mistake {
  std::string from;
  std::string to;
  std::string place;
  std::string path;
  std::string message;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.from << " -> " << mistake.to; }

class ChargeMistake : public testing::TestWithParam<Mistake> {};

TEST_P(ChargeMistake, IsReportedAtItsPlaceAndAlone) {
  const Mistake& m = GetParam();
  const std::string error = error_of(with(m.from, m.to, planar_case));
  EXPECT_EQ(error.rfind("case.yaml:" + m.place + ": " + m.path + ": ", 0), 0u) << error;
  EXPECT_NE(error.find(m.message), std::string::npos) << error;
  EXPECT_EQ(count_lines(error), 1u) << error;
}

const std::string middle = "center: [0, -3.5 in]";

const Mistake mistakes[] = {
    {middle, "center: [0, 1 in]", "29:5", "charges[0]", "must lie in liquid: no fill holds its middle"},
    {middle, "center: [0, -0.05 in]", "29:5", "charges[0]", "must lie in liquid, but reaches beyond"},
    {middle, "center: [0, -0.101 in]", "29:5", "charges[0]", "must lie in liquid, but reaches beyond"},
    {middle, "center: [11 in, -3 in]", "29:14", "charges[0].center", "must lie within the grid, x from 0 to 0.254"},
    {middle, "center: [-1 in, -3 in]", "29:14", "charges[0].center", "must lie within the grid, x from 0"},
    {middle, "center: [0, -5.9 in]", "29:5", "charges[0]", "reaches beyond the grid: to z = -0.1524"},
    {middle, "center: [9.9 in, -3 in]", "29:5", "charges[0]", "reaches beyond the grid: to x = 0.2540"},
    {middle, "center: [0.05 in, -3 in]", "29:14", "charges[0].center", "must lie on the plane of symmetry x = 0"},
    {"mass: 0.203 g", "mass: 0", "29:34", "charges[0].mass", "must be greater than 0"},
    {"mass: 0.203 g", "mass: -1 g", "29:34", "charges[0].mass", "must be greater than 0"},
    {"mass: 0.203 g", "mass: 1 in", "29:34", "charges[0].mass", "must be a mass (such as kg)"},
    {"radius_constant: 11", "radius_constant: 0", "29:60", "charges[0].radius_constant", "must be greater than 0"},
    {"minimum_radius_constant: 0.272", "minimum_radius_constant: -1", "29:89", "charges[0].minimum_radius_constant",
     "must be greater than 0"},
    {"adiabatic_exponent: 1.3", "adiabatic_exponent: 1", "29:116", "charges[0].adiabatic_exponent",
     "must be greater than 1, not 1"},
    {", thickness: 2 in", "", "29:5", "charges[0].thickness", "is required but missing: in planar cases"},
    {"thickness: 2 in", "thickness: 0", "29:132", "charges[0].thickness", "must be greater than 0"},
    {"radius_constant: 11", "radius_constant: 0.5", "29:5", "charges[0]", "would not expand against the pressure"},
    {"ambient_pressure: 33.9 ftH2O",
     "ambient_pressure: 33.9 ftH2O\nbubbles: [{center: [0, -3.4 in], radius: 0.1 in, "
     "pressure: 2 atm, adiabatic_exponent: 1.4}]",
     "30:5", "charges[0]", "overlaps bubbles[0] (case.yaml:13:11)"},
};
INSTANTIATE_TEST_SUITE_P(Charges, ChargeMistake, testing::ValuesIn(mistakes));

TEST(ConfigCharges, BallsHaveNoThicknessAndLieOnTheAxis) {
  const std::string text = ball(planar_case);
  EXPECT_EQ(error_of(text), "");
  EXPECT_NE(error_of(text, {"charges.0.thickness=2 in"}).find("charges[0].thickness: is for planar cases only"),
            std::string::npos);
  EXPECT_NE(error_of(text, {"charges.0.center=[1 in, -3.5 in]"}).find("charges[0].center: must lie on the axis"),
            std::string::npos);
}

TEST(ConfigCharges, NeedUnits) {
  const std::string error =
      error_of(valid_case, {"charges=[{center: [0, 0.5], mass: 1, radius_constant: 11, minimum_radius_constant: 0.272, "
                            "adiabatic_exponent: 1.3}]"});
  EXPECT_NE(error.find("charges: need units: SI"), std::string::npos) << error;
  EXPECT_EQ(count_lines(error), 1u) << error;
}

}  // namespace
}  // namespace quicksand
