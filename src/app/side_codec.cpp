#include <algorithm>
#include <iterator>

#include "app/case_codec.hpp"

namespace quicksand {

namespace {

namespace dim = dimension;

Codec<Inflow> inflow_codec() {
  const auto profile = choice<Profile>({{"uniform", Profile::uniform}, {"parabolic", Profile::parabolic}});
  return object<Inflow>({
      required("velocity", &Inflow::velocity, vector_of(dim::velocity),
               {"velocity at the profile's largest, into the grid", "", {"[1 m/s, 0]"}}),
      maybe("fill", &Inflow::fill, identifier(), {"species that comes in; gas where absent", "", {"mud"}}),
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
           required("open", &SideConfig::pressure, quantity(dim::pressure),
                    {"pressure outside: ambient_pressure, unless liquid stands outside", "1 atm", {"1 atm"}}),
           maybe("outside", &SideConfig::outside, identifier(),
                 {"species outside, which comes in where the flow wants it; gas where absent", "", {"water"}}),
       })},
      {"no_slip", SideKind::no_slip,
       object<SideConfig>({
           required("no_slip", &SideConfig::velocity, vector_of(dim::velocity),
                    {"velocity of the wall along itself", "", {"[1 m/s, 0]"}}),
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

}  // namespace

Codec<Boundaries> boundaries_codec() {
  const Codec<SideConfig> side = named("side", side_codec());
  return object<Boundaries>({
      maybe("x_min", &Boundaries::x_min, side, "side at the least x, or the axis"),
      maybe("x_max", &Boundaries::x_max, side, "side at the greatest x"),
      maybe("y_min", &Boundaries::y_min, side, "side at the least y (3-D only)"),
      maybe("y_max", &Boundaries::y_max, side, "side at the greatest y (3-D only)"),
      maybe("z_min", &Boundaries::z_min, side, {"bottom", "no_slip, symmetry where the flow is mirrored"}),
      maybe("z_max", &Boundaries::z_max, side, {"top", "{open: 1 atm}"}),
  });
}

}  // namespace quicksand
