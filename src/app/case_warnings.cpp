#include "app/case_warnings.hpp"

#include <algorithm>
#include <cmath>

#include "app/case_start.hpp"
#include "core/config_codec.hpp"
#include "core/config_reader.hpp"

namespace quicksand {

namespace {

/// SI densities below this are more likely meant in g/cm^3, kg/m^3.
constexpr double least_density = 50;
/// Regularised laws are about 2 / (alpha s) off Bingham's at the shear rate s.
constexpr double least_regularization = 10;

double length(const Vec<3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

std::vector<const SideConfig*> sides_of(const CaseConfig& config) {
  const Boundaries& b = config.boundaries;
  std::vector<const SideConfig*> sides;
  for (const auto* side : {&b.x_min, &b.x_max, &b.y_min, &b.y_max, &b.z_min, &b.z_max}) {
    if (*side) sides.push_back(&**side);
  }
  return sides;
}

/// Whether a species is filled in at the start or stands beyond a side.
bool is_used(const CaseConfig& config, const std::string& name) {
  const auto sides = sides_of(config);
  return std::any_of(config.initial.begin(), config.initial.end(),
                     [&](const InitialFill& fill) { return fill.fill == name; }) ||
         std::any_of(sides.begin(), sides.end(), [&](const SideConfig* side) {
           return (side->kind == SideKind::open && side->outside == name) ||
                  (side->kind == SideKind::inflow && side->inflow.fill == name);
         });
}

struct Regularization {
  double alpha = 0;
  double yield_stress = 0;
};

Regularization regularization_of(const Law& law) {
  if (const auto* l = std::get_if<Papanastasiou>(&law)) return {l->regularization, l->yield_stress};
  if (const auto* l = std::get_if<HerschelBulkley>(&law)) return {l->regularization, l->yield_stress};
  if (const auto* l = std::get_if<Casson>(&law)) return {l->regularization, l->yield_stress};
  return {};
}

/// The exponent of a regularised law against the time step and the time of the flow.
void warn_of_regularization(const CaseConfig& config, std::size_t s, CaseWarnings& found) {
  const auto [alpha, yield_stress] = regularization_of(config.species[s].law);
  if (!(yield_stress > 0)) return;
  const std::string path = child_path("species", s) + ".rheology.regularization";
  const double step = config.time.step.value_or(config.time.max_step.value_or(0));
  if (alpha < step) {
    found.push_back({path, "is " + brief(alpha) + ", shorter than a time step, " + brief(step) +
                               ": what counts as rigid may be sheared by more than 1 in a step; usual are 50 to 1000 "
                               "times the time of free fall, or a shorter step"});
    return;
  }
  // Explosions shear faster than gravity does.
  const double height = fall_height(config);
  if (!config.bubbles.empty() || !config.charges.empty() || !(height > 0)) return;
  const double speed = std::max(given_speed(config), std::sqrt(length(config.gravity) * height));
  const double product = alpha * speed / height;
  if (speed > 0 && product < least_regularization) {
    found.push_back({path, "is " + brief(alpha) + ", only " + brief(product) +
                               " times the time that the flow takes: the law is far from one with a yield stress; "
                               "usual are 50 to 1000 times, here " +
                               brief(50 * height / speed) + " to " + brief(1000 * height / speed)});
  }
}

}  // namespace

double fall_height(const CaseConfig& config) {
  const Extent domain = domain_of(config.grid);
  double top = domain.low[2];
  for (const InitialFill& fill : config.initial) {
    const double high = bounds(fill.shape, geometry_of(config.grid)).high[2];
    top = std::max(top, std::min(high, domain.high[2]));
  }
  return top - domain.low[2];
}

double given_speed(const CaseConfig& config) {
  double speed = 0;
  for (const InitialFill& fill : config.initial) speed = std::max(speed, length(fill.velocity));
  for (const SideConfig* side : sides_of(config)) {
    if (side->kind == SideKind::inflow) speed = std::max(speed, length(side->inflow.velocity));
    if (side->kind == SideKind::no_slip) speed = std::max(speed, length(side->velocity));
  }
  return speed;
}

void warn_of_physics(const CaseConfig& config, CaseWarnings& found) {
  if (config.gravity[2] > 0) {
    found.push_back({"gravity", "points upwards: a number is an acceleration downwards, " +
                                    shortest(config.gravity[2]) + ", a vector has a negative last component for it"});
  }
  for (std::size_t s = 0; s < config.species.size(); ++s) {
    const Species& species = config.species[s];
    const std::string path = child_path("species", s);
    if (!is_used(config, species.name)) {
      found.push_back({path, "species " + species.name +
                                 " is not present at the start and does not come in: usual is a "
                                 "shape in `initial` that it fills"});
    }
    if (config.units == UnitSystem::si && species.density < least_density) {
      found.push_back({path + ".density",
                       "is " + brief(species.density) + " kg/m^3, that of a gas; water has 1000 kg/m^3, or 1 g/cm^3"});
    }
    warn_of_regularization(config, s, found);
  }
  const bool creeps = std::any_of(config.species.begin(), config.species.end(), [](const Species& species) {
    return !std::holds_alternative<Inviscid>(species.law) && !std::holds_alternative<Newtonian>(species.law);
  });
  const double steady = config.time.until_steady.value_or(1);
  if (creeps && steady < 1e-3 && config.solver.viscous_tolerance >= 1e-4) {
    found.push_back({"time.until_steady", "is " + brief(steady) + " while solver.viscous_tolerance is " +
                                              brief(config.solver.viscous_tolerance) +
                                              ": the error of the stress may keep the flow from getting so steady; "
                                              "usual is 1e-3, or a viscous_tolerance of 1e-6"});
  }
}

CaseWarnings case_warnings(const CaseConfig& config) {
  CaseWarnings found;
  warn_of_grid(config, found);
  warn_of_physics(config, found);
  warn_of_time(config, found);
  if (fits(config)) warn_of_start(config, found);
  return found;
}

std::vector<std::string> located_warnings(const CaseConfig& config, const std::string& file,
                                          const std::vector<std::string>& settings) {
  ConfigDocument document = read_yaml_file(file);
  for (const std::string& setting : settings) apply_setting(document, setting);
  const Reading reading(std::move(document));
  std::vector<std::string> lines;
  for (const CaseWarning& warning : case_warnings(config)) {
    const ConfigNode& node = reading.nearest(warning.path);
    lines.push_back(to_string(node.path.empty() ? Place{file, 0, 0} : node.place) + ": " + warning.path + ": " +
                    warning.message);
  }
  return lines;
}

}  // namespace quicksand
