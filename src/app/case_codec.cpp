#include "app/case_codec.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>

#include "core/config_variant.hpp"

namespace quicksand {

namespace {

namespace dim = dimension;
constexpr Range fraction_of_one{0, 1, true};

Codec<UnitSystem> units_codec() { return choice<UnitSystem>({{"SI", UnitSystem::si}, {"none", UnitSystem::none}}); }

Codec<Inflow> inflow_codec() {
  const auto profile = choice<Profile>({{"uniform", Profile::uniform}, {"parabolic", Profile::parabolic}});
  return object<Inflow>({
      required("velocity", &Inflow::velocity, vector_of(dim::velocity), "velocity at the profile's largest"),
      maybe("fill", &Inflow::fill, identifier(), "species that comes in; gas where absent"),
      defaulted("profile", &Inflow::profile, profile, "uniform, or parabolic: zero at no-slip walls beside the side"),
  });
}

/// A word for sides without quantities, a mapping for those that have some.
Codec<SideConfig> side_codec() {
  const auto word = choice<SideKind>({{"axis", SideKind::axis},
                                      {"symmetry", SideKind::symmetry},
                                      {"free_slip", SideKind::free_slip},
                                      {"no_slip", SideKind::no_slip},
                                      {"periodic", SideKind::periodic}});
  const struct {
    std::string key;
    SideKind kind;
    Codec<SideConfig> codec;
  } mappings[] = {
      {"open", SideKind::open,
       object<SideConfig>({
           required("open", &SideConfig::pressure, quantity(dim::pressure), "pressure outside"),
           maybe("outside", &SideConfig::outside, identifier(), "species outside; gas where absent"),
       })},
      {"no_slip", SideKind::no_slip,
       object<SideConfig>({
           required("no_slip", &SideConfig::velocity, vector_of(dim::velocity), "velocity of the wall along itself"),
       })},
      {"inflow", SideKind::inflow,
       object<SideConfig>({required("inflow", &SideConfig::inflow, inflow_codec(), "what comes in, and how fast")})},
  };
  const std::vector maps(std::begin(mappings), std::end(mappings));
  Codec<SideConfig> codec;
  std::vector<ConfigNode> schemas{word.schema};
  for (const auto& map : maps) schemas.push_back(map.codec.schema);
  codec.schema = detail::one_of(std::move(schemas));
  const std::string or_mapping = " (or {open: PRESSURE}, {no_slip: VELOCITY}, {inflow: {velocity: VELOCITY}})";
  codec.read = [word, maps, or_mapping](Reading& reading, const ConfigNode& node, SideConfig& out) {
    out = SideConfig{};
    const std::size_t before = reading.problems().size();
    if (node.kind == ConfigNode::Kind::map) {
      const auto found =
          std::find_if(maps.begin(), maps.end(), [&](const auto& map) { return node.find(map.key) != nullptr; });
      if (found != maps.end()) {
        out.kind = found->kind;
        return found->codec.read(reading, node, out);
      }
    }
    if (node.kind == ConfigNode::Kind::scalar && node.text == "open") {
      return reading.problem(node, "an open side needs the pressure outside: {open: PRESSURE}");
    }
    word.read(reading, node, out.kind);
    if (reading.problems().size() > before) reading.amend_last(or_mapping);
  };
  codec.write = [word, maps](const SideConfig& side) {
    const bool plain_wall = side.kind == SideKind::no_slip && side.velocity == Vec<3>{};
    for (const auto& map : maps) {
      if (map.kind == side.kind && !plain_wall) return map.codec.write(side);
    }
    return word.write(side.kind);
  };
  return codec;
}

Codec<Boundaries> boundaries_codec() {
  const Codec<SideConfig> side = side_codec();
  return object<Boundaries>({
      maybe("x_min", &Boundaries::x_min, side, "side at the least x, or the axis"),
      maybe("x_max", &Boundaries::x_max, side, "side at the greatest x"),
      maybe("y_min", &Boundaries::y_min, side, "side at the least y (3-D only)"),
      maybe("y_max", &Boundaries::y_max, side, "side at the greatest y (3-D only)"),
      maybe("z_min", &Boundaries::z_min, side, "bottom"),
      maybe("z_max", &Boundaries::z_max, side, "top"),
  });
}

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

/// Pa s^n as a number, or as text with any unit of pressure and the word s^n: the unit depends on the index.
Codec<double> consistency_codec() {
  const auto pressure = quantity(dim::pressure, not_negative);
  Codec<double> codec = pressure;
  codec.read = [pressure](Reading& reading, const ConfigNode& node, double& out) {
    constexpr std::string_view power = " s^n";
    ConfigNode stress = node;
    double number = 0;
    const bool plain = std::from_chars(node.text.data(), node.text.data() + node.text.size(), number).ptr ==
                       node.text.data() + node.text.size();
    if (node.kind == ConfigNode::Kind::scalar && !plain) {
      if (!node.text.ends_with(power)) {
        reading.problem(node, "must be a number (in Pa s^n), or a pressure followed by s^n, such as 12 Pa s^n");
        return;
      }
      stress.text.resize(stress.text.size() - power.size());
    }
    pressure.read(reading, stress, out);
  };
  return codec;
}

Codec<Law> law_codec() {
  const auto viscosity = quantity(dim::viscosity, not_negative);
  const auto yield_stress = quantity(dim::pressure, not_negative);
  const auto regularization = quantity(dim::time, not_negative);
  return tagged<Law>(
      "law",
      {
          alternative<Law, Inviscid>("inviscid", {}, "no stress but the pressure"),
          alternative<Law, Newtonian>("newtonian",
                                      {required("viscosity", &Newtonian::viscosity, viscosity, "dynamic viscosity")},
                                      "stress proportional to the strain rate"),
          alternative<Law, Bingham>(
              "bingham",
              {required("viscosity", &Bingham::viscosity, viscosity, "viscosity above the yield stress"),
               required("yield_stress", &Bingham::yield_stress, yield_stress, "stress below which it is rigid")},
              "Bingham's law: rigid below the yield stress"),
          alternative<Law, Papanastasiou>(
              "papanastasiou",
              {
                  required("viscosity", &Papanastasiou::viscosity, viscosity, "viscosity above the yield stress"),
                  required("yield_stress", &Papanastasiou::yield_stress, yield_stress,
                           "stress below which there is hardly any flow"),
                  required("regularization", &Papanastasiou::regularization, regularization,
                           "exponent of the regularization, a time; larger is closer to Bingham's law"),
              },
              "Bingham's law made smooth by an exponential"),
          alternative<Law, HerschelBulkley>(
              "herschel_bulkley",
              {
                  required("consistency", &HerschelBulkley::consistency, consistency_codec(),
                           "stress beyond the yield stress at unit strain rate"),
                  required("index", &HerschelBulkley::index, quantity(dim::none, positive),
                           "exponent of the strain rate: below 1 shear thins, above it thickens"),
                  required("yield_stress", &HerschelBulkley::yield_stress, yield_stress,
                           "stress below which there is hardly any flow"),
                  required("regularization", &HerschelBulkley::regularization, regularization,
                           "exponent of the regularization, a time; not 0 where index is below 1"),
              },
              "a power of the strain rate beyond a yield stress, made smooth by an exponential"),
          alternative<Law, Casson>(
              "casson",
              {
                  required("viscosity", &Casson::viscosity, viscosity, "viscosity at large strain rates"),
                  required("yield_stress", &Casson::yield_stress, yield_stress,
                           "stress below which there is hardly any flow"),
                  required("regularization", &Casson::regularization, regularization,
                           "exponent of the regularization, a time; larger is closer to Casson's law"),
              },
              "roots of yield stress and viscous stress add up to that of the stress, made smooth by an exponential"),
      });
}

Codec<Species> species_codec() {
  const auto exponent = quantity(dim::none, not_negative);
  const auto concentration = object<Concentration>({
      defaulted("viscosity_exponent", &Concentration::viscosity_exponent, exponent,
                "growth of the viscosity with the species' share of the mixture; 0 is linear"),
      defaulted("yield_exponent", &Concentration::yield_exponent, exponent,
                "growth of the yield stress with the species' share of the mixture; 0 is linear"),
  });
  return object<Species>({
      required("name", &Species::name, identifier(), "name of the species in this file and in the results"),
      required("density", &Species::density, quantity(dim::density, positive), "mass per volume of the pure species"),
      required("rheology", &Species::law, law_codec(), "constitutive law and its parameters"),
      defaulted("concentration", &Species::concentration, concentration, "how the law depends on the concentration"),
  });
}

Codec<InitialFill> fill_codec() {
  return object<InitialFill>({
      required("fill", &InitialFill::fill, identifier(), "name of a species"),
      required("shape", &InitialFill::shape, shape_codec(), "where it is"),
      defaulted("velocity", &InitialFill::velocity, vector_of(dim::velocity), "how it moves at the start"),
  });
}

Codec<TimeSettings> time_codec() {
  const auto duration = quantity(dim::time, positive);
  return object<TimeSettings>({
      required("end", &TimeSettings::end, duration, "when the run ends; it begins at 0"),
      maybe("step", &TimeSettings::step, duration, "fixed time step (or give cfl and max_step)"),
      maybe("cfl", &TimeSettings::cfl, quantity(dim::none, fraction_of_one),
            "largest distance in cell widths that liquid moves in one step (or give step)"),
      maybe("max_step", &TimeSettings::max_step, duration, "largest time step, with cfl"),
      maybe("min_step", &TimeSettings::min_step, duration, "time step below which the run is given up, with cfl"),
      maybe("until_steady", &TimeSettings::until_steady, quantity(dim::none, positive),
            "the run ends earlier when the flow is as steady as this"),
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
                "eps: cells whose fractions add up to 1 - eps or more are liquid"),
      defaulted("tolerance", &SolverSettings::tolerance, tolerance,
                "relative residual of the projections, error of volume fractions in the redistribution"),
      defaulted("max_iterations", &SolverSettings::max_iterations, whole_number(1), "limit of a linear solve"),
      defaulted("viscous_tolerance", &SolverSettings::viscous_tolerance, tolerance,
                "accuracy of the viscous iteration"),
      defaulted("viscous_iteration", &SolverSettings::viscous_iteration, iteration, "method of the viscous iteration"),
      defaulted("viscous_max_iterations", &SolverSettings::viscous_max_iterations, whole_number(1),
                "limit of the viscous iteration"),
  });
}

Codec<CaseConfig> make_case_codec() {
  return object<CaseConfig>({
      required("title", &CaseConfig::title, text(), "what the case is"),
      defaulted("units", &CaseConfig::units, units_codec(),
                "SI: numbers are SI and quantities may carry a unit, as in 2.5 in; none: numbers only"),
      required("grid", &CaseConfig::grid, grid_codec(), "the domain and its cells"),
      required("boundaries", &CaseConfig::boundaries, boundaries_codec(), "the sides of the domain"),
      required("gravity", &CaseConfig::gravity, gravity_codec(), "acceleration downwards along z, or a vector"),
      defaulted("ambient_pressure", &CaseConfig::ambient_pressure, quantity(dim::pressure), "pressure of the open air"),
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

Codec<Shape> shape_codec() {
  const auto number = quantity(dim::length);
  const auto size = quantity(dim::length, positive);
  const auto point = vector_of(dim::length);
  const auto corner = [number] {
    Codec<PolygonPoint> codec;
    codec.schema = detail::list_schema(number.schema, 2);
    codec.schema.add("maxItems", make_integer(2));
    codec.read = [number](Reading& reading, const ConfigNode& node, PolygonPoint& out) {
      if (node.kind != ConfigNode::Kind::list || node.children.size() != 2) {
        reading.problem(node, "must be a point [x, z]");
        return;
      }
      number.read(reading, node.children[0], out.x);
      number.read(reading, node.children[1], out.z);
    };
    codec.write = [](const PolygonPoint& p) { return make_list({make_number(p.x), make_number(p.z)}); };
    return codec;
  }();
  return keyed<Shape>({
      alternative<Shape, BoxShape>("box",
                                   {required("from", &BoxShape::from, point, "lowest corner"),
                                    required("to", &BoxShape::to, point, "highest corner")},
                                   "box along the axes"),
      alternative<Shape, LayerShape>("layer",
                                     {required("bottom", &LayerShape::bottom, number, "z of the lower surface"),
                                      required("top", &LayerShape::top, number, "z of the upper surface")},
                                     "horizontal layer across the domain"),
      alternative<Shape, CylinderShape>("cylinder",
                                        {required("center", &CylinderShape::center, point, "middle of the base"),
                                         required("radius", &CylinderShape::radius, size, "radius"),
                                         required("height", &CylinderShape::height, size, "height above the base")},
                                        "upright cylinder"),
      alternative<Shape, SphereShape>("sphere",
                                      {required("center", &SphereShape::center, point, "middle"),
                                       required("radius", &SphereShape::radius, size, "radius")},
                                      "sphere; a disc in planar cases"),
      alternative<Shape, HalfSpaceShape>("half_space",
                                         {required("point", &HalfSpaceShape::point, point, "a point of the plane"),
                                          required("normal", &HalfSpaceShape::normal, vector_of(dim::none),
                                                   "direction out of the filled half, of any length")},
                                         "everything behind a plane"),
      alternative<Shape, PolygonShape>("polygon",
                                       {required("points", &PolygonShape::points, list_of(corner, 3),
                                                 "corners [x, z] in order; the last is joined to the first")},
                                       "polygon in the plane (x, z)"),
      alternative<Shape, WaveShape>(
          "wave",
          {maybe("bottom", &WaveShape::bottom, number, "filled from this z up to the wave (or give top)"),
           maybe("top", &WaveShape::top, number, "filled from the wave up to this z (or give bottom)"),
           required("level", &WaveShape::level, number, "mean z of the wave"),
           required("amplitude", &WaveShape::amplitude, number, "height of the wave above its mean at x = 0"),
           required("wavenumber", &WaveShape::wavenumber, quantity(dim::wavenumber, not_negative),
                    "k of the shape cos(k x), or J0(k r) in axisymmetric cases")},
          "layer bounded by a wave"),
  });
}

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
