// Values that are allowed but doubtful, and cases that give no warning.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/case_warnings.hpp"
#include "config_test_case.hpp"

namespace quicksand {
namespace {

/// A case without anything doubtful.
const std::string sound_case = R"(title: A column of mud
grid:
  dimension: 2
  x: {from: 0, to: 2, cells: 40}
  z: {from: 0, to: 1.5, cells: 30}
boundaries: {x_min: symmetry, x_max: no_slip, z_min: no_slip, z_max: {open: 0}}
gravity: 9.81
species:
  - {name: mud, density: 1500, rheology: {law: papanastasiou, viscosity: 5, yield_stress: 500, regularization: 50}}
initial:
  - {fill: mud, shape: {box: {from: [0, 0], to: [0.5, 1]}}}
time: {end: 2, cfl: 0.5, max_step: 0.01}
output: {fields: {every: 0.1}}
)";

struct Doubt {
  std::string path;
  std::string message;
  std::vector<std::string> settings;
};

void expect_alone(const Doubt& doubt) {
  SCOPED_TRACE(doubt.path + " " + doubt.message);
  const CaseWarnings warnings = case_warnings(parse_case(sound_case, "case.yaml", doubt.settings));
  ASSERT_EQ(warnings.size(), 1u) << (warnings.empty() ? "" : warnings[0].path + " and " + warnings[1].path);
  EXPECT_EQ(warnings[0].path, doubt.path);
  EXPECT_NE(warnings[0].message.find(doubt.message), std::string::npos) << warnings[0].message;
}

const std::string two_species =
    "species=[{name: mud, density: 1500, rheology: {law: inviscid}}, {name: water, density: 1000, rheology: {law: "
    "inviscid}}]";

const Doubt doubts[] = {
    {"grid", "MB of memory, and this machine has", {"grid.x.cells=1000000", "grid.z.cells=2000"}},
    {"grid.x", "differ in width by a factor of 1.5", {"grid.x=[{from: 0, to: 1, cells: 20}, {to: 2.05, cells: 14}]"}},
    {"stages[0].grid.z",
     "factor of 1.3",
     {"stages=[{until: 0.5, grid: {x: {from: 0, to: 2, cells: 40}, z: [{from: 0, to: 1, cells: 20}, {to: 1.5, cells: "
      "5, "
      "stretch: smooth}]}}]"}},
    {"regrid", "does nothing without bubbles or charges", {"regrid.bubble_cells=8"}},
    {"gravity", "points upwards: a number is an acceleration downwards, 9.81", {"gravity=-9.81"}},
    {"gravity", "points upwards", {"gravity=[0, 9.81]"}},
    {"species[1]", "water is not present at the start", {two_species}},
    {"species[0].density", "is 1.5 kg/m^3, that of a gas; water has 1000", {"species.0.density=1.5"}},
    {"species[0].rheology.regularization",
     "is 0.001, shorter than a time step, 0.01",
     {"species.0.rheology.regularization=1e-3"}},
    {"species[0].rheology.regularization", "the law is far from", {"species.0.rheology.regularization=0.1"}},
    {"time.until_steady", "solver.viscous_tolerance is 0.0001", {"time.until_steady=1e-5"}},
    {"time.step", "it moves 8.859 cells of 0.05 in a step", {"time={end: 2, step: 0.1}", "output.fields.every=0.5"}},
    {"time.cfl", "is 0.9 cells per step: surfaces of violent flow", {"time.cfl=0.9"}},
    {"time.max_step", "steps or more; usual are thousands", {"time.max_step=1e-7"}},
    {"time.max_step",
     "the wave's period is about",
     {"initial.0.shape={wave: {bottom: 0, level: 0.5, amplitude: 0.1, wavenumber: 6.28}}", "time.max_step=0.08"}},
    {"output.fields.every", "longer than the run, 2: nothing is written on the way", {"output.fields.every=3"}},
    {"output.checkpoint.every", "longer than the run", {"output.checkpoint.every=3"}},
    {"output.crater.every", "longer than the run", {"output.crater={species: mud, every: 3}"}},
    {"output.fields.every", "about 2002 files of fields until 2, some", {"output.fields.every=0.000999"}},
    {"output.fields.every", "shorter than a step, 0.005", {"time={end: 2, step: 0.005}", "output.fields.every=0.003"}},
    {"initial[0].shape", "is 1 cells thick along z, 0.05 where cells", {"initial.0.shape.box.to.1=0.05"}},
    {"initial[0].shape",
     "crosses the plane of symmetry x = 0 with its middle 0.1 off it",
     {"initial.0.shape={sphere: {center: [0.1, 0.5], radius: 0.4}}"}},
    {"bubbles[0]",
     "the radius 0.1 is 2 cells; fewer than 4 do not resolve it",
     {"bubbles=[{center: [0, 0.5], radius: 0.1, pressure: 2, adiabatic_exponent: 1.4}]"}},
    {"bubbles[0]",
     "the radius 0.02 is 0.4 cells, less than one",
     {"bubbles=[{center: [0, 0.5], radius: 0.02, pressure: 2, adiabatic_exponent: 1.4}]"}},
    {"boundaries.z_max", "less than 2 cells from the open side z_max", {"initial.0.shape.box.to.1=1.45"}},
};
TEST(ConfigWarnings, EachDoubtIsWarnedOfAlone) {
  for (const Doubt& doubt : doubts) expect_alone(doubt);
}

TEST(ConfigWarnings, SoundCasesGiveNone) {
  EXPECT_TRUE(case_warnings(parse_case(sound_case, "case.yaml")).empty());
  // A species that comes in from outside is present.
  const std::vector<std::string> inflow = {two_species,
                                           "boundaries.x_max={inflow: {velocity: [-0.1, 0], fill: water}}"};
  EXPECT_TRUE(case_warnings(parse_case(sound_case, "case.yaml", inflow)).empty());
  const std::vector<std::string> regrid = {
      "bubbles=[{center: [0, 0.5], radius: 0.02, pressure: 2, adiabatic_exponent: 1.4}]", "regrid.bubble_cells=8"};
  EXPECT_TRUE(case_warnings(parse_case(sound_case, "case.yaml", regrid)).empty());
}

TEST(ConfigWarnings, ShippedCasesGiveOnlyThoseThatAreTrue) {
  // A coarse grid that widens fast, and a bubble of a radius of 3.2 cells, for comparison.
  const std::pair<std::string, std::string> known[] = {{"crater_3d.yaml", "grid."}, {"free_disc.yaml", "bubbles[0]"}};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(QUICKSAND_SOURCE_DIR "/configs")) {
    if (entry.path().extension() != ".yaml") continue;
    const CaseConfig config = read_case(entry.path().string());
    for (const CaseWarning& warning : case_warnings(config)) {
      const bool is_known = std::any_of(std::begin(known), std::end(known), [&](const auto& k) {
        return entry.path().filename() == k.first && warning.path.starts_with(k.second);
      });
      EXPECT_TRUE(is_known) << entry.path() << ": " << warning.path << ": " << warning.message;
    }
  }
}

}  // namespace
}  // namespace quicksand
