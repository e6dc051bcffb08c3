#include "app/case_reference.hpp"

#include "app/case_codec.hpp"
#include "core/config_explanation.hpp"

namespace quicksand {

namespace {

/// A case that runs in seconds and has each section that most cases have.
constexpr const char* first_case = R"(title: Collapse of a column of mud
units: SI
grid:
  dimension: 2
  geometry: planar
  x: {from: 0, to: 2, cells: 64}
  z: {from: 0, to: 1, cells: 32}
boundaries: {x_min: symmetry, x_max: no_slip, z_min: no_slip, z_max: {open: 0}}
gravity: 9.81
species:
  - {name: mud, density: 1500, rheology: {law: papanastasiou, viscosity: 5, yield_stress: 500, regularization: 20}}
initial:
  - {fill: mud, shape: {box: {from: [0, 0], to: [0.5, 0.75]}}}
time: {end: 1.5, cfl: 0.5, max_step: 0.01}
output: {directory: results/mud, fields: {every: 0.05}}
)";

}  // namespace

std::string explained_case(const CaseConfig& config) {
  return explained_yaml(case_codec().write(config), case_codec().schema, false);
}

std::string case_template() {
  return "# A case to begin with: change it, then `quicksand check` and `quicksand run` it. In brackets: what may be\n"
         "# given, and the default. Keys behind a # are not given.\n\n" +
         explained_yaml(case_codec().write(parse_case(first_case, "template")), case_codec().schema, true);
}

std::string explain_key(const std::string& path) { return explain_keys(case_codec().schema, path); }

std::string case_reference() { return reference_page(case_codec().schema); }

}  // namespace quicksand
