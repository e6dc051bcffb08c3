#include "app/case_codec.hpp"

namespace quicksand {

namespace {

namespace dim = dimension;
constexpr Range fraction_of_one{0, 1, true};

Codec<UnitSystem> units_codec() { return choice<UnitSystem>({{"SI", UnitSystem::si}, {"none", UnitSystem::none}}); }

/// A number, downwards along z, or a vector.
Codec<Vec<3>> gravity_codec() {
  const auto down = quantity(dim::acceleration);
  const auto vector = vector_of(dim::acceleration);
  Codec<Vec<3>> codec;
  codec.schema = detail::one_of({down.schema, vector.schema});
  codec.read = [down, vector](Reading& reading, const ConfigNode& node, Vec<3>& out) {
    if (node.kind == ConfigNode::Kind::list) return vector.read(reading, node, out);
    double g = 0;
    down.read(reading, node, g);
    out = Vec<3>{{0, 0, 0 - g}};
  };
  codec.write = [down, vector](const Vec<3>& g) {
    return g[0] == 0 && g[1] == 0 ? down.write(0 - g[2]) : vector.write(g);
  };
  return codec;
}

Codec<InitialFill> fill_codec() {
  return object<InitialFill>({
      required("fill", &InitialFill::fill, identifier(), {"name of the species that fills the shape", "", {"mud"}}),
      required("shape", &InitialFill::shape, shape_codec(), "where it is"),
      defaulted("velocity", &InitialFill::velocity, vector_of(dim::velocity),
                {"how it moves at the start", "at rest", {"[0, -1 m/s]"}}),
  });
}

Codec<TimeSettings> time_codec() {
  const auto duration = quantity(dim::time, positive);
  return object<TimeSettings>({
      required("end", &TimeSettings::end, duration,
               {"when the run ends; it begins at 0",
                "a few times the time of free fall, (2 height / gravity)^(1/2)",
                {"2 s"}}),
      maybe("step", &TimeSettings::step, duration,
            {"fixed time step (or give cfl and max_step)",
             "to compare with tables; liquid may move about half a cell in it",
             {"0.5 ms"}}),
      maybe("cfl", &TimeSettings::cfl, quantity(dim::none, fraction_of_one),
            {"largest distance in cell widths that liquid moves in one step (or give step)",
             "0.5; 0.3 where details of the surface matter",
             {"0.5"}}),
      maybe("max_step", &TimeSettings::max_step, duration,
            {"largest time step, with cfl",
             "the interval of the fields, or less where the flow begins slowly",
             {"5 ms"}}),
      maybe("min_step", &TimeSettings::min_step, duration,
            {"time step below which the run is given up, with cfl", "a thousandth of max_step", {"1e-6 s"}}),
      maybe("until_steady", &TimeSettings::until_steady, quantity(dim::none, positive),
            {"the run ends earlier when the flow is as steady as this: time |du/dt| / max |u|",
             "1e-3; less wants a viscous_tolerance below the default",
             {"1e-3"}}),
  });
}

Codec<SolverSettings> solver_codec() {
  const auto iteration = choice<ViscousIteration>({{"newton", ViscousIteration::newton},
                                                   {"anderson", ViscousIteration::anderson},
                                                   {"picard", ViscousIteration::picard},
                                                   {"dual", ViscousIteration::dual}});
  const auto tolerance = quantity(dim::none, {0, 0.1, true});
  return object<SolverSettings>({
      defaulted("liquid_threshold", &SolverSettings::liquid_threshold, quantity(dim::none, {0, 0.99, true}),
                {"eps: cells whose fractions add up to 1 - eps or more are liquid", "the default; it hardly matters"}),
      defaulted("tolerance", &SolverSettings::tolerance, tolerance,
                {"relative residual of the projections, error of volume fractions in the redistribution",
                 "1e-6 to 1e-9; volume and energy are kept as well as this"}),
      defaulted("max_iterations", &SolverSettings::max_iterations, whole_number(1),
                {"most iterations of such a solve", "the default; solves take 5 to 50"}),
      defaulted(
          "viscous_tolerance", &SolverSettings::viscous_tolerance, tolerance,
          {"accuracy of the viscous iteration: gradient norm relative to that without stress; with law bingham the "
           "duality gap, relative to the energy of what stress does in the step",
           "1e-4; 1e-6 where slow creep or steady flow matters"}),
      defaulted("viscous_iteration", &SolverSettings::viscous_iteration, iteration,
                {"method of the viscous iteration",
                 "newton; the others are there for comparison, dual for law bingham only"}),
      defaulted(
          "viscous_max_iterations", &SolverSettings::viscous_max_iterations, whole_number(1),
          {"most iterations of Newton's method; ten times as many of the others", "the default; steps take 3 to 20"}),
  });
}

Codec<CaseConfig> make_case_codec() {
  return object<CaseConfig>({
      required("title", &CaseConfig::title, text(),
               {"what the case is; it heads the results", "", {"Collapse of a column of mud"}}),
      defaulted("units", &CaseConfig::units, units_codec(),
                "SI: numbers are SI and quantities may carry a unit, as in 2.5 in; none: numbers only"),
      required("grid", &CaseConfig::grid, grid_codec(), "the domain and its cells"),
      required("boundaries", &CaseConfig::boundaries, boundaries_codec(), "the sides of the domain"),
      required("gravity", &CaseConfig::gravity, gravity_codec(),
               {"acceleration downwards along z, or a vector",
                "9.81 in SI, 1 where lengths and times are scaled with it; 0 switches it off. A "
                "component along a periodic axis drives a flow",
                {"9.81", "[0.5, 0, -9.81]"}}),
      defaulted("ambient_pressure", &CaseConfig::ambient_pressure, quantity(dim::pressure),
                {"pressure of the open air, of all gas but that of bubbles",
                 "1 atm; without bubbles only differences of pressure matter",
                 {"1 atm"}}),
      required("species", &CaseConfig::species, list_of(species_codec(), 1),
               "the liquids and slurries; where two are pressed together the earlier keeps its place"),
      required("initial", &CaseConfig::initial, list_of(fill_codec(), 1), "what is filled at the start"),
      defaulted("bubbles", &CaseConfig::bubbles, list_of(bubble_codec()),
                "gas with a pressure of its own, cut out of the liquid"),
      defaulted("charges", &CaseConfig::charges, list_of(charge_codec()),
                "explosive charges, which start as bubbles; units: SI only"),
      defaulted("trapped_gas", &CaseConfig::trapped_gas, trapped_gas_codec(), "ambient gas that liquid encloses"),
      required("time", &CaseConfig::time, time_codec(), "end of the run and time step"),
      defaulted("stages", &CaseConfig::stages, list_of(stage_codec()),
                "grids of the first parts of the run, in order of time; the flow is moved from one to the next"),
      maybe("regrid", &CaseConfig::regrid, regrid_codec(), "grids that follow the bubbles of the start as they grow"),
      defaulted("solver", &CaseConfig::solver, solver_codec(), "settings of the numerical method"),
      defaulted("guard", &CaseConfig::guard, guard_codec(), "when a step counts as failed, and what becomes of it"),
      defaulted("output", &CaseConfig::output, output_codec(), "what is written, where and when"),
  });
}

}  // namespace

const Codec<CaseConfig>& case_codec() {
  static const Codec<CaseConfig> codec = make_case_codec();
  return codec;
}

UnitSystem peek_units(const ConfigNode& root) {
  const ConfigNode* units = root.find("units");
  return units != nullptr && units->text == "none" ? UnitSystem::none : UnitSystem::si;
}

int peek_dimension(const ConfigNode& root) {
  const ConfigNode* grid = root.find("grid");
  const ConfigNode* node = grid != nullptr ? grid->find("dimension") : nullptr;
  if (node == nullptr) return 0;
  return node->text == "2" ? 2 : node->text == "3" ? 3 : 0;
}

}  // namespace quicksand
