// Every kind of mistake in a case file is reported with its line, column and key.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "config_test_case.hpp"

namespace quicksand {
namespace {

struct Mistake {
  std::string from;
  std::string to;
  std::string place;  ///< line and column
  std::string path;
  std::string message;  ///< part of it
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.from << " -> " << mistake.to; }

class ConfigMistake : public testing::TestWithParam<Mistake> {};

TEST_P(ConfigMistake, IsReportedAtItsPlaceAndAlone) {
  const Mistake& m = GetParam();
  const std::string error = error_of(with(m.from, m.to));
  EXPECT_EQ(error.rfind("case.yaml:" + m.place + ": " + m.path + ": ", 0), 0u) << error;
  EXPECT_NE(error.find(m.message), std::string::npos) << error;
  EXPECT_EQ(count_lines(error), 1u) << error;
}

const Mistake value_mistakes[] = {
    {"title: A test", "title: [1]", "1:8", "title", "must be text, not a list"},
    {"title: A test", "title:", "1:1", "title", "must be text, not nothing"},
    {"units: none", "units: metric", "2:8", "units", "must be one of SI, none, not 'metric'"},
    {"dimension: 2", "dimension: 4", "4:14", "grid.dimension", "must be from 2 to 3, not 4"},
    {"dimension: 2", "dimension: two", "4:14", "grid.dimension", "whole number from 2 to 3, not 'two'"},
    {"axisymmetric", "axisymetric", "5:13", "grid.geometry", "did you mean 'axisymmetric'?"},
    {"cells: 16", "cells: 0", "6:32", "grid.x.cells", "must be from 1 to"},
    {"cells: 16", "cells: 1.5", "6:32", "grid.x.cells", "must be a whole number"},
    {"cells: 16", "cells: \"16\"", "6:32", "grid.x.cells", "must be a whole number"},
    {"cells: 48", "cells: 99999999999999999999", "7:32", "grid.z.cells", "must be from 1 to"},
    {"to: 0.5", "to: 0", "6:20", "grid.x.to", "must be greater than from = 0, not 0"},
    {"from: 0, to: 1.5", "from: 2, to: 1.5", "7:20", "grid.z.to", "must be greater than from = 2"},
    {"from: 0, to: 1.5", "to: 1.5", "7:6", "grid.z.from", "is required but missing"},
    {"from: 0, to: 0.5", "from: -0.5, to: 0.5", "6:6", "grid.x", "negative radius"},
    {"to: 0.5", "to: .inf", "6:20", "grid.x.to", "must be finite"},
    {"to: 0.5", "to: nan", "6:20", "grid.x.to", "must be finite"},
    {"to: 0.5", "to: 1e999", "6:20", "grid.x.to", "within the range"},
    {"to: 0.5", "to: 2.5 in", "6:20", "grid.x.to", "takes a plain number where units are none"},
    {"x: {from: 0, to: 0.5, cells: 16}", "x: [{from: 0, to: 0.2, cells: 4}, {from: 0.3, to: 0.5, cells: 4}]", "6:44",
     "grid.x[1].from", "must be where the segment before ends, 0.2, not 0.3"},
    {"x: {from: 0, to: 0.5, cells: 16}", "x: []", "6:6", "grid.x", "needs at least 1 item"},
    {"x: {from: 0, to: 0.5, cells: 16}", "x: [{from: 0, to: 0.2, cells: 40}, {to: 0.5, cells: 2, stretch: smooth}]",
     "6:6", "grid.x", "use more cells"},
    {"  z_min: no_slip", "  z_min: no_slip\n  y_min: no_slip", "12:10", "boundaries.y_min", "dimension: 2 has no y"},
    {"x_min: axis", "x_min: no_slip", "9:10", "boundaries.x_min", "must be axis"},
    {"x_max: no_slip", "x_max: axis", "10:10", "boundaries.x_max", "axis is for x_min"},
    {"x_max: no_slip", "x_max: noslip", "10:10", "boundaries.x_max", "did you mean 'no_slip'?"},
    {"x_max: no_slip", "x_max: periodic", "10:10", "boundaries.x_max", "must not be periodic: x is the radius"},
    {"z_min: no_slip", "z_min: periodic", "12:10", "boundaries.z_max", "must be periodic as z_min is, or neither"},
    {"z_max: {open: 1.0}", "z_max: periodic", "11:10", "boundaries.z_min", "must be periodic as z_max is, or neither"},
    {"{law: newtonian, viscosity: 0.01}",
     "{law: herschel_bulkley, consistency: 1, index: 0.5, yield_stress: 0, regularization: 0}", "21:100",
     "species[1].rheology.regularization", "must be greater than 0 where index is below 1"},
    {"{law: newtonian, viscosity: 0.01}",
     "{law: herschel_bulkley, consistency: 1, index: 0, yield_stress: 0, regularization: 1}", "21:62",
     "species[1].rheology.index", "must be greater than 0"},
    {"{law: newtonian, viscosity: 0.01}",
     "{law: herschel_bulkley, consistency: 1 Pa s, index: 2, yield_stress: 0, regularization: 1}", "21:52",
     "species[1].rheology.consistency", "a pressure followed by s^n, such as 12 Pa s^n"},
    {"{law: newtonian, viscosity: 0.01}", "{law: bingham, viscosity: 0.01}", "21:15",
     "species[1].rheology.yield_stress", "is required but missing"},
    {"x_max: no_slip", "x_max: open", "10:10", "boundaries.x_max", "{open: PRESSURE}"},
    {"{open: 1.0}", "{open: 2.0}", "12:17", "boundaries.z_max.open", "must be ambient_pressure = 1, not 2"},
    {"ambient_pressure: 1.0\n", "", "12:17", "boundaries.z_max.open", "must be ambient_pressure = 0, not 1"},
    {"{open: 1.0}", "{open: 2.0, outside: snad}", "12:31", "boundaries.z_max.outside", "did you mean 'sand'?"},
    {"x_max: no_slip", "x_max: {no_slip: [1, 0]}", "10:20", "boundaries.x_max.no_slip", "must point along the wall"},
    {"z_min: no_slip", "z_min: {no_slip: [1, 0]}", "11:20", "boundaries.z_min.no_slip", "must point along z"},
    {"x_max: no_slip", "x_max: {inflow: {velocity: [1, 0], fill: sand}}", "10:30", "boundaries.x_max.inflow.velocity",
     "must point into the grid"},
    {"x_max: no_slip", "x_max: {inflow: {velocity: [-1, 0], fill: mud}}", "10:45", "boundaries.x_max.inflow.fill",
     "is not a species; they are sand, water"},
    {"x_max: no_slip", "x_max: {inflow: {fill: sand}}", "10:19", "boundaries.x_max.inflow.velocity",
     "is required but missing"},
    {"x_max: no_slip", "x_max: {slip: 1}", "10:10", "boundaries.x_max", "{inflow: {velocity: VELOCITY}}"},
    {"fields: {every: 0.1}", "crater: {species: snad}", "28:21", "output.crater.species", "did you mean 'sand'?"},
    {"fields: {every: 0.1}", "crater: {species: sand, level: 2}", "28:34", "output.crater.level",
     "must lie within the grid, from z = 0 to 1.5, not at 2"},
    {"fields: {every: 0.1}", "crater: {species: [sand, sand]}", "28:28", "output.crater.species[1]",
     "in the list already"},
    {"fields: {every: 0.1}", "crater: {species: []}", "28:21", "output.crater.species", "needs at least 1 item"},
    {"fields: {every: 0.1}", "crater: {level: 1}", "28:11", "output.crater.species", "is required but missing"},
    {"end: 4.0", "end: 4.0, until_steady: 0", "25:32", "time.until_steady", "must be greater than 0"},
    {"  x_max: no_slip\n", "", "9:3", "boundaries.x_max", "is required but missing"},
    {"gravity: 1.0", "gravity: [1, 2]", "13:10", "gravity", "must point along z"},
    {"gravity: 1.0", "gravity: [0, 1, 0]", "13:10", "gravity", "y component must be 0"},
    {"gravity: 1.0", "gravity: [1]", "13:10", "gravity", "must be a vector"},
    {"gravity: 1.0", "gravity: {z: 1}", "13:10", "gravity", "must be a number, not a mapping"},
    {"name: water", "name: sand", "19:11", "species[1].name", "case.yaml:16:11"},
    {"name: water", "name: sea water", "19:11", "species[1].name", "letters, digits and _"},
    {"density: 2.0", "density: -2.0", "17:14", "species[0].density", "must be greater than 0, not -2.0"},
    {"density: 2.0", "density: 0", "17:14", "species[0].density", "must be greater than 0"},
    {"    density: 2.0\n", "", "16:5", "species[0].density", "is required but missing"},
    {"law: papanastasiou", "law: elastic", "18:21", "species[0].rheology.law", "inviscid, newtonian, bingham"},
    {"law: newtonian, ", "", "21:15", "species[1].rheology.law", "is required but missing"},
    {"yield_stress: 0.3", "yield_stress: -0.3", "18:66", "species[0].rheology.yield_stress", "must be at least 0"},
    {"regularization: 200", "regularization: -1", "18:87", "species[0].rheology.regularization", "must be at least 0"},
    {"fill: sand", "fill: snad", "23:11", "initial[0].fill", "they are sand, water; did you mean 'sand'?"},
    {"center: [0, 0, 0]", "center: [0.1, 0, 0]", "24:32", "initial[0].shape.cylinder.center", "must lie on the axis"},
    {"radius: 0.25", "radius: 0.75", "24:12", "initial[0].shape", "reaches beyond the grid: to x = 0.75"},
    {"height: 1.0", "height: 2.0", "24:12", "initial[0].shape", "reaches beyond the grid: to z = 2"},
    {"radius: 0.25", "radius: 0", "24:51", "initial[0].shape.cylinder.radius", "must be greater than 0"},
    {"end: 4.0", "end: 0", "25:13", "time.end", "must be greater than 0"},
    {"step: 5.0e-4", "step: 5", "25:24", "time.step", "must not be longer than the run, 4"},
    {", step: 5.0e-4", "", "25:7", "time.step", "give step, or cfl with max_step"},
    {"step: 5.0e-4", "cfl: 1.5, max_step: 1", "25:23", "time.cfl", "greater than 0 and at most 1, not 1.5"},
    {"step: 5.0e-4", "cfl: 0.5", "25:7", "time.max_step", "is required but missing"},
    {"step: 5.0e-4", "step: 1, max_step: 1", "25:37", "time.max_step", "goes with cfl only"},
    {"step: 5.0e-4", "step: 1, cfl: 0.3, max_step: 1", "25:32", "time.cfl", "not both"},
    {"every: 0.1", "times: [0.1, 0.3, 0.2]", "28:30", "output.fields.times[2]", "times must increase"},
    {"every: 0.1", "times: [0.1, 5]", "28:25", "output.fields.times[1]", "is after the end of the run"},
    {"every: 0.1", "every: 0.1, times: [1]", "28:31", "output.fields.times", "not both"},
    {"every: 0.1", "every: -1", "28:19", "output.fields.every", "must be greater than 0"},
};
INSTANTIATE_TEST_SUITE_P(Values, ConfigMistake, testing::ValuesIn(value_mistakes));

/// Replaces the line of the time settings by a bubble in line 26 and the time.
std::string bubble(const std::string& keys, const std::string& more = "") {
  return "bubbles:\n  - {" + keys + "}\n" + more + "time: {";
}

const Mistake bubble_mistakes[] = {
    {"time: {", bubble("center: [0, 0.5], radius: 0.1, pressure: 2, adiabatic_exponent: 1"), "26:70",
     "bubbles[0].adiabatic_exponent", "must be greater than 1, not 1"},
    {"time: {", bubble("center: [0, 0.5], radius: 0.1, pressure: 2"), "26:5", "bubbles[0].adiabatic_exponent",
     "is required but missing"},
    {"time: {", bubble("center: [0.1, 0.5], radius: 0.1, pressure: 2, adiabatic_exponent: 1.4"), "26:14",
     "bubbles[0].center", "must lie on the axis"},
    {"time: {", bubble("center: [0, 0.2], radius: 0.2, pressure: 2, adiabatic_exponent: 1.4"), "26:5", "bubbles[0]",
     "reaches beyond the grid"},
    {"time: {", bubble("center: [0, 0.95], radius: 0.1, pressure: 2, adiabatic_exponent: 1.4"), "26:5", "bubbles[0]",
     "must lie in liquid"},
    {"time: {",
     bubble("center: [0, 0.5], radius: 0.1, pressure: 2, adiabatic_exponent: 1.4",
            "  - {center: [0, 0.6], radius: 0.1, pressure: 2, adiabatic_exponent: 1.4}\n"),
     "27:5", "bubbles[1]", "overlaps bubbles[0] (case.yaml:26:5)"},
    {"time: {", "trapped_gas: {adiabatic: maybe}\ntime: {", "25:26", "trapped_gas.adiabatic", "true"},
};
INSTANTIATE_TEST_SUITE_P(Bubbles, ConfigMistake, testing::ValuesIn(bubble_mistakes));

const Mistake key_mistakes[] = {
    {"ambient_pressure", "ambient_presure", "14:1", "ambient_presure", "did you mean 'ambient_pressure'?"},
    {"geometry: axi", "colour: red\n  geometry: axi", "5:3", "grid.colour",
     "allowed keys are dimension, geometry, x, y, z"},
    {"gravity: 1.0", "gravity: 1.0\nbubble: []", "14:1", "bubble", "unknown key"},
    {"gravity: 1.0", "gravity: 1.0\ngravity: 2.0", "14:1", "gravity", "given twice; first in line 13"},
    {"viscosity: 0.01", "viscosity: 0.01, yield_stress: 1", "21:49", "species[1].rheology.yield_stress",
     "unknown key for 'newtonian'; allowed keys are law, viscosity"},
    {"output:", "solver: {tolerence: 1e-8}\noutput:", "26:10", "solver.tolerence", "did you mean 'tolerance'?"},
};
INSTANTIATE_TEST_SUITE_P(Keys, ConfigMistake, testing::ValuesIn(key_mistakes));

TEST(ConfigErrors, AllAreReportedAtOnceInTheOrderOfTheFile) {
  std::string text = with("density: 2.0", "density: -2");
  text = with("title: A test\n", "", text);
  text = with("cells: 16", "cells: 0", text);
  text = with("end: 4.0", "end: -4", text);
  text = with("gravity", "gravty", text);
  const std::string error = error_of(text, {"species.1.density=x"});
  ASSERT_EQ(count_lines(error), 7u) << error;
  std::size_t last = 0;
  for (const std::string part : {"title: is required", "grid.x.cells", "gravty: unknown key; did you mean 'gravity'?",
                                 "species[0].density", "time.end", "--set species.1.density=x: species[1].density"}) {
    const std::size_t at = error.find(part);
    ASSERT_NE(at, std::string::npos) << part << "\n" << error;
    EXPECT_GE(at, last) << part;
    last = at;
  }
}

TEST(ConfigErrors, OverlapNamesBothFills) {
  const std::string second = "\n  - fill: water\n    shape: {layer: {bottom: 0.9, top: 1.2}}\ntime:";
  const std::string error = error_of(with("\ntime:", second));
  EXPECT_EQ(error, "case.yaml:26:12: initial[1].shape: overlaps initial[0].shape (case.yaml:24:12)");
  EXPECT_EQ(error_of(with("\ntime:", "\n  - fill: water\n    shape: {layer: {bottom: 1, top: 1.2}}\ntime:")), "")
      << "shapes that touch do not overlap";
}

TEST(ConfigErrors, DimensionThreeNeedsItsThirdAxisAndPlanarGeometry) {
  const std::string error = error_of(with("dimension: 2", "dimension: 3"));
  for (const std::string part : {"grid.y: is required", "axisymmetric needs dimension: 2",
                                 "boundaries.y_min: is required", "boundaries.y_max: is required"}) {
    EXPECT_NE(error.find(part), std::string::npos) << part << "\n" << error;
  }
}

TEST(ConfigErrors, UnitsMustFitTheQuantity) {
  const std::string si = with("units: none\n", "");
  EXPECT_NE(error_of(si, {"gravity=3 kg"}).find("acceleration"), std::string::npos);
  EXPECT_NE(error_of(si, {"gravity=3 kg"}).find("'kg' is a mass"), std::string::npos);
  EXPECT_NE(error_of(si, {"grid.x.to=3 parsek"}).find("unknown unit 'parsek'"), std::string::npos);
  EXPECT_NE(error_of(si, {"species.0.concentration={yield_exponent: 1 m}"}).find("plain number"), std::string::npos);
}

TEST(ConfigErrors, FilesThatAreNoCases) {
  const auto error_of_file = [](const std::string& file) {
    try {
      read_case(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(error_of_file("/nonexistent/case.yaml").find("no such file"), std::string::npos);
  EXPECT_NE(error_of_file(testing::TempDir()).find("is a folder"), std::string::npos);
  const std::string binary = testing::TempDir() + "quicksand_binary.yaml";
  std::ofstream(binary) << std::string("a\0b", 3);
  EXPECT_NE(error_of_file(binary).find("is not a text file"), std::string::npos);
  std::filesystem::remove(binary);
}

TEST(ConfigErrors, TextThatIsNoMapping) {
  EXPECT_EQ(error_of(""), "case.yaml: is empty");
  EXPECT_EQ(error_of("# only a comment\n"), "case.yaml: is empty");
  EXPECT_NE(error_of("just text").find("case.yaml:1:1: must be a mapping"), std::string::npos);
  EXPECT_NE(error_of("- 1\n- 2").find("must be a mapping of keys, not a list"), std::string::npos);
  EXPECT_EQ(error_of("a: [1\nb: 2").rfind("case.yaml:2:", 0), 0u);
  EXPECT_NE(error_of("a: [1\nb: 2").find("not valid YAML"), std::string::npos);
  EXPECT_NE(error_of("a: 1\n---\nb: 2").find("second YAML document"), std::string::npos);
  EXPECT_NE(error_of("a: &x 1\nb: *x").find("case.yaml:2:4: aliases"), std::string::npos);
  EXPECT_NE(error_of("[1, 2]: 3").find("a key must be a single word"), std::string::npos);
}

TEST(ConfigErrors, DeepNestingIsRefused) {
  EXPECT_NE(error_of(std::string(100000, '[')).find("not valid YAML"), std::string::npos);
}

TEST(ConfigErrors, CutFilesAreRefused) {
  // Whatever line the file ends at before its last section: an error, and never another exception.
  for (std::size_t end = valid_case.find("time:"); end-- > 0;) {
    if (valid_case[end] != '\n') continue;
    EXPECT_NE(error_of(valid_case.substr(0, end)), "");
  }
}

}  // namespace
}  // namespace quicksand
