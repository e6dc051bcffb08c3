// Reading whole cases: values, defaults, settings, round trip, schema.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "config_test_case.hpp"

namespace quicksand {
namespace {

TEST(ConfigCase, ReadsEveryValue) {
  const CaseConfig config = parse_case(valid_case, "case.yaml");
  EXPECT_EQ(config.title, "A test");
  EXPECT_EQ(config.units, UnitSystem::none);
  EXPECT_EQ(config.grid.dimension, 2);
  EXPECT_EQ(config.grid.geometry, Geometry::axisymmetric);
  ASSERT_EQ(config.grid.x.size(), 1u);
  EXPECT_EQ(config.grid.x[0].to, 0.5);
  EXPECT_EQ(config.grid.z[0].cells, 48);
  EXPECT_EQ(config.boundaries.x_min->kind, SideKind::axis);
  EXPECT_EQ(config.boundaries.z_max->kind, SideKind::open);
  EXPECT_EQ(config.boundaries.z_max->pressure, 1.0);
  EXPECT_FALSE(config.boundaries.y_min.has_value());
  EXPECT_EQ(config.gravity, (Vec<3>{{0, 0, -1}}));
  ASSERT_EQ(config.species.size(), 2u);
  EXPECT_EQ(config.species[0].density, 2.0);
  const auto& law = std::get<Papanastasiou>(config.species[0].law);
  EXPECT_EQ(law.viscosity, 0.1);
  EXPECT_EQ(law.yield_stress, 0.3);
  EXPECT_EQ(law.regularization, 200);
  EXPECT_EQ(std::get<Newtonian>(config.species[1].law).viscosity, 0.01);
  const auto& cylinder = std::get<CylinderShape>(config.initial[0].shape);
  EXPECT_EQ(cylinder.radius, 0.25);
  EXPECT_EQ(cylinder.height, 1.0);
  EXPECT_EQ(config.time.end, 4.0);
  EXPECT_EQ(config.time.step, 5e-4);
  EXPECT_FALSE(config.time.cfl.has_value());
  EXPECT_EQ(config.output.fields.every, 0.1);
}

TEST(ConfigCase, FillsDefaults) {
  const CaseConfig config = parse_case(with("output:\n  directory: results/test\n  fields: {every: 0.1}\n", ""), "c");
  EXPECT_EQ(config.solver.liquid_threshold, 0.5);
  EXPECT_EQ(config.solver.tolerance, 1e-9);
  EXPECT_EQ(config.solver.viscous_tolerance, 1e-4);
  EXPECT_EQ(config.solver.viscous_iteration, ViscousIteration::newton);
  EXPECT_EQ(config.initial[0].velocity, (Vec<3>{}));
  EXPECT_EQ(config.species[0].concentration.yield_exponent, 0);
  EXPECT_TRUE(config.output.history);
  EXPECT_TRUE(config.output.fields.times.empty());
}

TEST(ConfigCase, ShownCaseReadsBackToTheSame) {
  const std::vector<std::vector<std::string>> variants = {
      {},
      {"time={end: 0.1, cfl: 0.3, max_step: 0.012345678901234567, min_step: 1e-300}", "gravity=[0, 0, -9.81]"},
      {"title=\"quoted: \\\"text\\\", # 'no comment'\\n- line\"", "output.fields={times: [0, 0.1, 3.3333333333333335]}",
       "output.crater={species: sand, level: 0.25, every: 0.1}"},
      {"title='2024'", "output.directory='true'", "gravity=0"},
      {"initial.0.shape={wave: {bottom: 0, level: 0.4, amplitude: -0.1, wavenumber: 7.66}}"},
      {"initial.0.shape={polygon: {points: [[0, 0], [0.1, 0], [0.2, 0.7], [0, 0.9]]}}"},
      {"initial.0.shape={half_space: {point: [0, 0, 0.3], normal: [0.1, 0, 1]}}"},
      {"species.1.rheology={law: inviscid}", "species.1.concentration={yield_exponent: 5}"},
      {"boundaries.z_max={open: 2, outside: water}", "boundaries.x_max={no_slip: [0, 0.5]}", "time.until_steady=1e-4"},
      {"boundaries.z_min={inflow: {velocity: [0, 1], fill: sand, profile: parabolic}}"},
      {"grid.x=[{from: 0, to: 0.3, cells: 30}, {to: 0.5, cells: 8, stretch: smooth}]"},
  };
  for (const auto& settings : variants) {
    const std::string shown = to_yaml(parse_case(valid_case, "case.yaml", settings));
    EXPECT_EQ(to_yaml(parse_case(shown, "shown")), shown);
  }
}

TEST(ConfigCase, ShownNumbersAreExact) {
  for (const std::string number : {"0.1", "1e-300", "4.9e-324", "0.30000000000000004", "123456789012345678", "1e23"}) {
    const CaseConfig config =
        parse_case(valid_case, "case.yaml", {"ambient_pressure=" + number, "boundaries.z_max.open=" + number});
    const CaseConfig again = parse_case(to_yaml(config), "shown");
    EXPECT_EQ(again.ambient_pressure, config.ambient_pressure) << number;
  }
}

TEST(ConfigCase, ConsistencyIsAPressureTimesAPowerOfSeconds) {
  for (const std::string text : {"1200", "1200 Pa s^n", "1.2 kPa s^n", "12 hPa s^n"}) {
    const CaseConfig config = parse_case(with("units: none", "units: SI"), "case.yaml",
                                         {"species.0.rheology={law: herschel_bulkley, consistency: " + text +
                                          ", index: 0.4, yield_stress: 1, regularization: 1}"});
    EXPECT_NEAR(std::get<HerschelBulkley>(config.species[0].law).consistency, 1200, 1e-10) << text;
    EXPECT_EQ(to_yaml(parse_case(to_yaml(config), "shown")), to_yaml(config));
  }
}

TEST(ConfigCase, TextKeepsItsCharacters) {
  const std::string title = "a: b # c \"d\" \\ é\tf\ng";
  CaseConfig config = parse_case(valid_case, "case.yaml");
  config.title = title;
  EXPECT_EQ(parse_case(to_yaml(config), "shown").title, title);
}

TEST(ConfigCase, SettingsReplaceValues) {
  const CaseConfig config = parse_case(
      valid_case, "case.yaml",
      {"species.0.density=3", "species[1].name=brine", "solver.tolerance=1e-9", "output.fields={times: [1, 2]}",
       "initial.0.shape.cylinder.center.2=0.25", "time.end=1", "time.end=2"});
  EXPECT_EQ(config.species[0].density, 3);
  EXPECT_EQ(config.species[1].name, "brine");
  EXPECT_EQ(config.solver.tolerance, 1e-9);
  EXPECT_EQ(config.output.fields.times.size(), 2u);
  EXPECT_FALSE(config.output.fields.every.has_value());
  EXPECT_EQ(std::get<CylinderShape>(config.initial[0].shape).center[2], 0.25);
  EXPECT_EQ(config.time.end, 2) << "the last setting of a key wins";
}

TEST(ConfigCase, SettingErrorsNameTheOption) {
  const auto error = [](const std::string& setting) { return error_of(valid_case, {setting}); };
  EXPECT_EQ(error("species.0.density=-1"),
            "--set species.0.density=-1: species[0].density: must be greater than 0, not -1");
  EXPECT_EQ(error("species.2.density=1"),
            "--set species.2.density=1: species: is a list of 2; name its elements by 0 to 1, not '2'");
  EXPECT_EQ(error("grid.x"), "--set grid.x: must have the form KEY.PATH=VALUE");
  EXPECT_EQ(error("=1"), "--set =1: must have the form KEY.PATH=VALUE");
  EXPECT_EQ(error("title.a=1"), "--set title.a=1: title: is a single value and has no 'a'");
  EXPECT_EQ(error("title=[a"), "--set title=[a: title: the value is not valid YAML");
  EXPECT_NE(error("solver.tolerence=1").find("did you mean 'tolerance'?"), std::string::npos);
  EXPECT_NE(error("title=").find("must be text, not nothing"), std::string::npos);
}

TEST(ConfigCase, UnitsAreConverted) {
  const std::string si = with("units: none\n", "");
  const CaseConfig config =
      parse_case(si, "case.yaml",
                 {"grid.x={from: 0, to: 20 in, cells: 16}", "species.0.density=2 g/cm^3", "ambient_pressure=33.9 ftH2O",
                  "boundaries.z_max={open: 33.9 ftH2O}", "time.step=0.5 ms", "gravity=32.174 ft/s^2", "time.end=4 s",
                  "species.1.rheology.viscosity=1 cP", "species.0.rheology.yield_stress=1 kPa",
                  "initial.0.velocity=[0, 0, 1 cm/s]"});
  EXPECT_NEAR(config.grid.x[0].to, 0.508, 1e-15);
  EXPECT_NEAR(config.species[0].density, 2000, 1e-9);
  EXPECT_NEAR(config.ambient_pressure, 33.9 * 2989.06692, 1e-6);
  EXPECT_NEAR(config.boundaries.z_max->pressure, 33.9 * 2989.06692, 1e-6);
  EXPECT_NEAR(*config.time.step, 5e-4, 1e-18);
  EXPECT_NEAR(config.gravity[2], -9.80665, 1e-4);
  EXPECT_NEAR(std::get<Newtonian>(config.species[1].law).viscosity, 1e-3, 1e-18);
  EXPECT_EQ(std::get<Papanastasiou>(config.species[0].law).yield_stress, 1000);
  EXPECT_NEAR(config.initial[0].velocity[2], 0.01, 1e-17);
}

TEST(ConfigCase, EveryShippedCaseIsValidAndShowsItself) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(QUICKSAND_SOURCE_DIR "/configs")) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    SCOPED_TRACE(entry.path().string());
    std::string shown;
    ASSERT_NO_THROW(shown = to_yaml(read_case(entry.path().string())));
    EXPECT_EQ(to_yaml(parse_case(shown, "shown")), shown);
  }
  EXPECT_GE(files, 15);
}

TEST(ConfigCase, SchemaDescribesKeysAndDefaults) {
  const std::string schema = case_schema();
  for (const std::string part : {"\"$schema\"", "\"liquid_threshold\"", "\"papanastasiou\"", "\"half_space\"",
                                 "\"default\": \"SI\"", "\"additionalProperties\": false", "\"exclusiveMinimum\": 0"}) {
    EXPECT_NE(schema.find(part), std::string::npos) << part;
  }
}

TEST(ConfigGrid, UniformFacesAreExactAtTheEnds) {
  const std::vector<double> faces = make_faces({{0.1, 0.7, 7, Stretch::uniform}});
  ASSERT_EQ(faces.size(), 8u);
  EXPECT_EQ(faces.front(), 0.1);
  EXPECT_EQ(faces.back(), 0.7);
}

TEST(ConfigGrid, SmoothSegmentsContinueTheNeighboursWidth) {
  // The fine grid of a box 30 in wide: 0.12 in up to 9 in, then coarser.
  const std::vector<double> faces = make_faces({{-30.0, -9.0, 12, Stretch::smooth},
                                                {std::nullopt, 9.0, 150, Stretch::uniform},
                                                {9.0, 30.0, 12, Stretch::smooth}});
  ASSERT_EQ(faces.size(), 175u);
  const auto width = [&](std::size_t i) { return faces[i + 1] - faces[i]; };
  EXPECT_NEAR(width(11), 0.12, 1e-12);
  EXPECT_NEAR(width(12), 0.12, 1e-12);
  EXPECT_NEAR(width(162), 0.12, 1e-12);
  EXPECT_EQ(faces.back(), 30.0);
  const double ratio = width(163) / width(162);
  for (std::size_t i = 163; i < 173; ++i) EXPECT_NEAR(width(i + 1) / width(i), ratio, 1e-9);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(width(i), width(173 - i), 1e-9);
}

TEST(ConfigGrid, ImpossibleSmoothSegmentsAreRefused) {
  EXPECT_THROW(make_faces({{0.0, 1.0, 4, Stretch::smooth}}), InputError);
  EXPECT_THROW(make_faces({{0.0, 1.0, 100, Stretch::uniform}, {1.0, 2.0, 2, Stretch::smooth}}), InputError);
  EXPECT_THROW(make_faces({{0.0, 1.0, 2, Stretch::uniform}, {1.0, 1.1, 5, Stretch::smooth}}), InputError);
  EXPECT_THROW(
      make_faces({{0.0, 1.0, 4, Stretch::uniform}, {1.0, 2.0, 4, Stretch::smooth}, {2.0, 3.0, 4, Stretch::uniform}}),
      InputError);
}

TEST(ConfigGrid, BuildsGridAndSides) {
  const CaseConfig config = parse_case(valid_case, "case.yaml");
  const Grid<2> grid = make_grid<2>(config.grid);
  EXPECT_TRUE(grid.axisymmetric());
  EXPECT_EQ(grid.global_cells(), (Index<2>{{16, 48}}));
  const Sides<2> sides = make_sides<2>(config);
  EXPECT_EQ(sides.at(0, 0).kind, SideKind::axis);
  EXPECT_EQ(sides.at(1, 1).pressure, 1.0);
  EXPECT_EQ((in_axes<2>(Vec<3>{{1, 2, 3}})), (Vec<2>{{1, 3}}));
  EXPECT_EQ((in_axes<3>(Vec<3>{{1, 2, 3}})), (Vec<3>{{1, 2, 3}}));
}

}  // namespace
}  // namespace quicksand
