#include <algorithm>
#include <cmath>

#include "app/bubble_checks.hpp"
#include "app/case_codec.hpp"
#include "app/crater_codec.hpp"
#include "app/grid_checks.hpp"
#include "app/shape_checks.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Whether two pressures differ by no more than the conversion of units may cause.
bool same_pressure(double a, double b) { return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b)); }

/// Notes a species that does not exist.
void check_name(const CaseConfig& config, const std::optional<std::string>& name, const std::string& path,
                Reading& reading) {
  if (!name || !reading.clean("species") || species_number(config, *name) < config.species.size()) return;
  std::vector<std::string> names;
  for (const Species& species : config.species) names.push_back(species.name);
  reading.problem(path, in_quotes(*name) + " is not a species; they are " + join(names) + suggestion(*name, names));
}

/// Notes what is wrong with the quantities of a side.
/// \param across  component of vectors that is normal to it
void check_side(const CaseConfig& config, const SideConfig& side, const std::string& path, int across,
                bool ambient_known, Reading& reading) {
  const bool axisymmetric = config.grid.geometry == Geometry::axisymmetric;
  if (side.kind == SideKind::open) {
    check_name(config, side.outside, path + ".outside", reading);
    if (!side.outside && ambient_known && !same_pressure(side.pressure, config.ambient_pressure)) {
      reading.problem(path + ".open", "must be ambient_pressure = " + shortest(config.ambient_pressure) + ", not " +
                                          shortest(side.pressure) +
                                          ": all gas outside has one pressure (name a species in `outside` if liquid "
                                          "stands there)");
    }
  }
  if (side.kind == SideKind::no_slip && side.velocity[across] != 0) {
    reading.problem(path + ".no_slip", "must point along the wall");
  }
  if (side.kind == SideKind::inflow) {
    check_name(config, side.inflow.fill, path + ".inflow.fill", reading);
    const double inwards = (path.ends_with("_min") ? 1 : -1) * side.inflow.velocity[across];
    if (reading.clean(path) && !(inwards > 0)) reading.problem(path + ".inflow.velocity", "must point into the grid");
  }
  const bool inflow = side.kind == SideKind::inflow;
  const bool radial = across != 0 && (inflow ? side.inflow.velocity : side.velocity)[0] != 0;
  if (axisymmetric && radial) {
    reading.problem(path + (inflow ? ".inflow.velocity" : ".no_slip"), "must point along z in axisymmetric cases");
  }
}

void check_boundaries(const CaseConfig& config, Reading& reading) {
  const GridConfig& grid = config.grid;
  const Boundaries& b = config.boundaries;
  const ConfigNode* given = reading.root().find("boundaries");
  if (given == nullptr || given->kind != ConfigNode::Kind::map || !reading.clean("grid.dimension")) return;
  const struct {
    const char* name;
    const std::optional<SideConfig>& side;
    bool exists;
    int across;  ///< component of vectors normal to the side
  } sides[] = {{"x_min", b.x_min, true, 0},
               {"x_max", b.x_max, true, 0},
               {"y_min", b.y_min, grid.dimension == 3, 1},
               {"y_max", b.y_max, grid.dimension == 3, 1},
               {"z_min", b.z_min, true, 2},
               {"z_max", b.z_max, true, 2}};
  const bool axisymmetric = grid.geometry == Geometry::axisymmetric;
  const bool has_axis = axisymmetric && !grid.x.empty() && grid.x.front().from == 0.0;
  // Where it is missing and something else is wrong, it may be given under a misspelt key.
  const bool ambient_known = reading.root().find("ambient_pressure") != nullptr ? reading.clean("ambient_pressure")
                                                                                : reading.problems().empty();
  for (const auto& [name, side, exists, across] : sides) {
    const std::string path = std::string("boundaries.") + name;
    if (side && !exists) reading.problem(path, "dimension: 2 has no y; its sides are x_min, x_max, z_min, z_max");
    if (!side && exists) {
      reading.problem(path,
                      "is required but missing: one of axis, symmetry, free_slip, no_slip, periodic, {open: PRESSURE}, "
                      "{inflow: ...}");
    }
    if (!side || !exists || !reading.clean(path) || !reading.clean("grid")) continue;
    if (side->kind == SideKind::periodic && axisymmetric && name[0] == 'x') {
      reading.problem(path, "must not be periodic: x is the radius of an axisymmetric grid");
      continue;
    }
    const bool is_axis = side->kind == SideKind::axis;
    if (is_axis && (!has_axis || path != "boundaries.x_min")) {
      reading.problem(
          path, "axis is for x_min of an axisymmetric grid that begins at x = 0; a plane of symmetry is symmetry");
    }
    if (!is_axis && has_axis && path == "boundaries.x_min") {
      reading.problem(path, "must be axis: the axisymmetric grid begins at x = 0");
    }
    check_side(config, *side, path, across, ambient_known, reading);
  }
}

/// Both sides of an axis are periodic, or none.
void check_periodic(const Boundaries& b, Reading& reading) {
  const struct {
    const char* name;
    const std::optional<SideConfig>&low, &high;
  } axes[] = {{"x", b.x_min, b.x_max}, {"y", b.y_min, b.y_max}, {"z", b.z_min, b.z_max}};
  for (const auto& [name, low, high] : axes) {
    const std::string low_path = std::string("boundaries.") + name + "_min";
    const std::string high_path = std::string("boundaries.") + name + "_max";
    if (!low || !high || !reading.clean(low_path) || !reading.clean(high_path)) continue;
    const bool low_periodic = low->kind == SideKind::periodic;
    if (low_periodic == (high->kind == SideKind::periodic)) continue;
    reading.problem(low_periodic ? high_path : low_path,
                    std::string("must be periodic as ") + name + (low_periodic ? "_min" : "_max") +
                        " is, or neither: the two sides of a periodic axis are one");
  }
}

void check_species(const std::vector<Species>& species, Reading& reading) {
  for (std::size_t i = 0; i < species.size(); ++i) {
    const std::string law = child_path("species", i) + ".rheology";
    const auto* power = std::get_if<HerschelBulkley>(&species[i].law);
    if (power != nullptr && reading.clean(law) && power->index < 1 && power->regularization == 0) {
      reading.problem(law + ".regularization",
                      "must be greater than 0 where index is below 1: without it the viscosity at rest is infinite");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (species[i].name.empty() || species[i].name != species[j].name) continue;
      const std::string first = child_path("species", j) + ".name";
      reading.problem(child_path("species", i) + ".name", in_quotes(species[i].name) +
                                                              " is the name of another species too, " +
                                                              to_string(reading.nearest(first).place));
    }
  }
}

void check_time(const TimeSettings& time, Reading& reading) {
  if (reading.nearest("time").kind != ConfigNode::Kind::map || reading.nearest("time").path.empty()) return;
  // Whether keys are present can be judged even where their values are wrong.
  if (time.step && time.cfl) reading.problem("time.cfl", "give either step or cfl with max_step, not both");
  if (!time.step && !time.cfl) reading.problem("time.step", "is required but missing: give step, or cfl with max_step");
  if (time.cfl && !time.max_step) reading.problem("time.max_step", "is required but missing: largest step, with cfl");
  if (!time.cfl && time.max_step) reading.problem("time.max_step", "goes with cfl only");
  if (!time.cfl && time.min_step) reading.problem("time.min_step", "goes with cfl only");
  if (!reading.clean("time.step") || !reading.clean("time.end")) return;
  if (time.step && *time.step > time.end) {
    reading.problem("time.step", "must not be longer than the run, " + shortest(time.end));
  }
  if (!reading.clean("time.min_step") || !reading.clean("time.max_step")) return;
  if (time.min_step && time.max_step && *time.min_step > *time.max_step) {
    reading.problem("time.min_step", "must not be greater than max_step = " + shortest(*time.max_step));
  }
}

void check_output(const CaseConfig& config, Reading& reading) {
  const OutputSchedule& fields = config.output.fields;
  const std::string path = "output.fields.times";
  if (fields.every && !fields.times.empty()) reading.problem(path, "give either every or times, not both");
  if (!reading.clean(path)) return;
  for (std::size_t i = 0; i < fields.times.size(); ++i) {
    if (i > 0 && !(fields.times[i] > fields.times[i - 1])) {
      reading.problem(child_path(path, i), "times must increase: " + shortest(fields.times[i]) + " comes after " +
                                               shortest(fields.times[i - 1]));
    }
    if (reading.clean("time.end") && config.time.end > 0 && fields.times[i] > config.time.end) {
      reading.problem(child_path(path, i), "is after the end of the run, " + shortest(config.time.end));
    }
  }
}

}  // namespace

void check_case(const CaseConfig& config, Reading& reading) {
  check_grid(config.grid, reading);
  check_stages(config, reading);
  check_boundaries(config, reading);
  check_periodic(config.boundaries, reading);
  const bool axisymmetric = config.grid.geometry == Geometry::axisymmetric;
  if (axisymmetric && reading.clean("gravity") && (config.gravity[0] != 0 || config.gravity[1] != 0)) {
    reading.problem("gravity", "must point along z in axisymmetric cases");
  }
  check_species(config.species, reading);
  check_initial(config, reading);
  check_bubbles(config, reading);
  check_time(config.time, reading);
  check_output(config, reading);
  check_crater(config, reading);
}

}  // namespace quicksand
