// Mistakes that users make in case files: each is refused with its line and key, and says what is allowed.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/case_codec.hpp"
#include "config_test_case.hpp"
#include "core/config_keys.hpp"

namespace quicksand {
namespace {

/// A case in SI with every section.
const std::string full_case = R"(title: A bubble under mud
units: SI
grid:
  dimension: 2
  geometry: planar
  x: [{from: 0, to: 1 m, cells: 20}, {to: 2, cells: 10, stretch: smooth}]
  z: {from: -1 m, to: 1 m, cells: 40}
boundaries:
  x_min: symmetry
  x_max: {no_slip: [0, 0]}
  z_min: no_slip
  z_max: {open: 1 atm}
gravity: 9.81 m/s^2
ambient_pressure: 1 atm
species:
  - name: mud
    density: 1500 kg/m^3
    rheology: {law: bingham, viscosity: 1 Pa s, yield_stress: 100 Pa}
    concentration: {viscosity_exponent: 0, yield_exponent: 2}
  - name: water
    density: 1 g/cm^3
    rheology: {law: newtonian, viscosity: 1 cP}
initial:
  - fill: mud
    shape: {layer: {bottom: -1 m, top: -0.5 m}}
  - fill: water
    shape: {box: {from: [0, -0.5], to: [2, 0.5]}}
    velocity: [0, 0 cm/s]
bubbles:
  - {center: [0, 0], radius: 20 cm, pressure: 2 atm, adiabatic_exponent: 1.4}
charges:
  - center: [0, -0.7]
    mass: 1 g
    radius_constant: 11
    minimum_radius_constant: 0.272
    adiabatic_exponent: 1.3
    thickness: 1 m
trapped_gas: {adiabatic: true, adiabatic_exponent: 1.4}
time: {end: 1 s, cfl: 0.5, max_step: 10 ms, min_step: 1e-9}
stages:
  - until: 0.5 s
    grid: {x: {from: 0, to: 2, cells: 30}, z: {from: -1, to: 1, cells: 40}}
regrid: {bubble_cells: 8}
solver: {liquid_threshold: 0.5, tolerance: 1e-9, max_iterations: 500}
guard: {halvings: 8, volume_error: 1e-9, energy_rise: 1e-6}
output:
  directory: results/test
  fields: {every: 50 ms}
  checkpoint: {every: 0.1, wall_interval: 900}
  history: true
  crater: {species: mud, level: -0.5}
)";

struct Bad {
  std::string from;
  std::string to;
  int line;             ///< of the message
  std::string key;      ///< path; empty where the text is no YAML
  std::string message;  ///< part of it
};

/// One test for all of them: that takes less time than a process for each.
void expect_refused(const Bad& bad) {
  SCOPED_TRACE(bad.from + " -> " + bad.to);
  const std::string error = error_of(with(bad.from, bad.to, full_case));
  const std::string place = "case.yaml:" + std::to_string(bad.line) + ":";
  std::istringstream lines(error);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.starts_with(place) && line.find(bad.key.empty() ? ": " : ": " + bad.key + ": ") != std::string::npos)
      break;
  }
  ASSERT_TRUE(lines) << "no line for " << place << " " << bad.key << " in\n" << error;
  EXPECT_NE(line.find(bad.message), std::string::npos) << line;
}

const Bad syntax[] = {
    {"title: A", "title A", 2, "", "not valid YAML"},
    {"title: A", "title:A", 2, "", "not valid YAML"},
    {"title: A", "\ttitle: A", 1, "", "not valid YAML"},
    {"  dimension: 2", "\tdimension: 2", 4, "", "not valid YAML"},
    {"  dimension: 2", "   dimension: 2", 5, "", "not valid YAML"},
    {"  geometry: planar", "geometry: planar", 6, "", "not valid YAML"},
    {"cells: 40}", "cells: 40", 8, "", "not valid YAML"},
    {"cells: 20}, {", "cells: 20, {", 6, "", "YAML"},
    {"stretch: smooth}]", "stretch: smooth}", 7, "", "not valid YAML"},
    {"{open: 1 atm}", "{open: 1 atm}}", 12, "", "not valid YAML"},
    {"[0, 0 cm/s]", "[0, 0 cm/s", 29, "", "not valid YAML"},
    {"title: A bubble", "title: \"A bubble", 1, "", "not valid YAML"},
    {"title: A bubble", "title: 'A bubble", 1, "", "not valid YAML"},
    {"title: A bubble", "title: @A bubble", 1, "", "not valid YAML"},
    {"title: A bubble", "title: `A bubble", 1, "", "not valid YAML"},
    {"title: A bubble", "title: %A bubble", 1, "", "not valid YAML"},
    {"title: A bubble", "title: \"A \\q bubble\"  #", 1, "", "not valid YAML"},
    {"title: A bubble under mud", "title: A bubble: under mud", 1, "", "not valid YAML"},
    {"  - name: mud", "  -name: mud", 17, "", "not valid YAML"},
    {"  - name: water", "  name: water", 20, "", "not valid YAML"},
    {"gravity: 9.81 m/s^2", "gravity: &g 9.81\nambient_pressure: *g", 14, "", "aliases"},
    {"gravity: 9.81 m/s^2", "gravity: *g", 13, "", "not valid YAML: the referenced anchor is not defined"},
    {"gravity: 9.81 m/s^2", "<<: {gravity: 9.81}", 13, "<<", "unknown key"},
    {"grid:\n", "grid: &grid\n  x: *grid\n", 4, "", "aliases"},
    {"gravity: 9.81 m/s^2", "? [gravity]\n: 9.81", 13, "", "a key must be a single word"},
    {"gravity: 9.81 m/s^2", "{gravity: 9.81}", 13, "", "YAML"},
    {"time: {", "---\ntime: {", 40, "", "second YAML document"},
    {"title: A", "--- !case\n- title: A", 3, "", "YAML"},
    {"boundaries:\n", "boundaries: |\n", 8, "boundaries", "must be a mapping of keys"},
    {"boundaries:\n", "boundaries: >\n", 8, "boundaries", "must be a mapping of keys"},
    {"output:\n", "output: none\nx_output:\n", 46, "output", "must be a mapping of keys, not 'none'"},
    {"units: SI", "units: SI\nunits: none", 3, "units", "given twice; first in line 2"},
    {"  geometry: planar", "  geometry: planar\n  geometry: axisymmetric", 6, "grid.geometry", "given twice"},
    {"  - name: mud\n", "  - name: mud\n    name: sand\n", 17, "species[0].name", "given twice; first in line 16"},
    {"viscosity: 1 Pa s,", "viscosity: 1 Pa s, viscosity: 2 Pa s,", 18, "species[0].rheology.viscosity", "given twice"},
};
TEST(BadCases, Syntax) {
  for (const Bad& bad : syntax) expect_refused(bad);
}

const Bad keys[] = {
    {"title:", "titel:", 1, "titel", "did you mean 'title'?"},
    {"title:", "Title:", 1, "Title", "did you mean 'title'?"},
    {"units:", "unit:", 2, "unit", "did you mean 'units'?"},
    {"grid:", "mesh:", 3, "mesh", "allowed keys are title, units, grid"},
    {"  dimension", "  dimensions", 4, "grid.dimensions", "did you mean 'dimension'?"},
    {"  geometry", "  geometri", 5, "grid.geometri", "did you mean 'geometry'?"},
    {"  x: [", "  r: [", 6, "grid.r", "allowed keys are dimension, geometry, x, y, z"},
    {"  x: [{from", "  x: [{form", 6, "grid.x[0].form", "did you mean 'from'?"},
    {"cells: 20", "cell: 20", 6, "grid.x[0].cell", "did you mean 'cells'?"},
    {"stretch: smooth", "strech: smooth", 6, "grid.x[1].strech", "did you mean 'stretch'?"},
    {"boundaries:", "boundary:", 8, "boundary", "did you mean 'boundaries'?"},
    {"x_min: symmetry", "xmin: symmetry", 9, "boundaries.xmin", "did you mean 'x_min'?"},
    {"x_min: symmetry", "left: symmetry", 9, "boundaries.left", "allowed keys are x_min, x_max"},
    {"z_max: {open", "z_max: {oppen", 12, "boundaries.z_max", "{open: PRESSURE}"},
    {"{open: 1 atm}", "{open: 1 atm, outsid: water}", 12, "boundaries.z_max.outsid", "did you mean 'outside'?"},
    {"gravity:", "g:", 13, "g", "allowed keys are"},
    {"ambient_pressure:", "ambient_preassure:", 14, "ambient_preassure", "did you mean 'ambient_pressure'?"},
    {"species:", "fluids:", 15, "fluids", "unknown key"},
    {"density: 1500", "rho: 1500", 17, "species[0].rho", "allowed keys are name, density, rheology, concentration"},
    {"rheology: {law: bingham", "rheologie: {law: bingham", 18, "species[0].rheologie", "did you mean 'rheology'?"},
    {"{law: bingham", "{model: bingham", 18, "species[0].rheology.law", "is required but missing: one of inviscid"},
    {"yield_stress: 100", "yieldstress: 100", 18, "species[0].rheology.yieldstress", "did you mean 'yield_stress'?"},
    {"yield_stress: 100 Pa", "yield_stress: 100 Pa, regularization: 1", 18, "species[0].rheology.regularization",
     "unknown key for 'bingham'; allowed keys are law, viscosity, yield_stress"},
    {"yield_exponent", "yield_exponant", 19, "species[0].concentration.yield_exponant",
     "did you mean 'yield_exponent'?"},
    {"initial:", "intial:", 23, "intial", "did you mean 'initial'?"},
    {"  - fill: mud", "  - fluid: mud", 24, "initial[0].fluid", "allowed keys are fill, shape, velocity"},
    {"shape: {layer", "shapes: {layer", 25, "initial[0].shapes", "did you mean 'shape'?"},
    {"{layer: {bottom", "{layers: {bottom", 25, "initial[0].shape.layers", "did you mean 'layer'?"},
    {"bottom: -1 m", "botom: -1 m", 25, "initial[0].shape.layer.botom", "did you mean 'bottom'?"},
    {"{box: {from", "{box: {form", 27, "initial[1].shape.box.form", "did you mean 'from'?"},
    {"    velocity: [0", "    veloctiy: [0", 28, "initial[1].veloctiy", "did you mean 'velocity'?"},
    {"bubbles:", "bubble:", 29, "bubble", "did you mean 'bubbles'?"},
    {"{center: [0, 0]", "{centre: [0, 0]", 30, "bubbles[0].centre", "did you mean 'center'?"},
    {"radius: 20 cm", "r: 20 cm", 30, "bubbles[0].r", "allowed keys are center, radius"},
    {"charges:", "charge:", 31, "charge", "did you mean 'charges'?"},
    {"    radius_constant", "    radius_const", 34, "charges[0].radius_const", "did you mean 'radius_constant'?"},
    {"    minimum_radius_constant", "    min_radius_constant", 35, "charges[0].min_radius_constant", "unknown key"},
    {"trapped_gas:", "traped_gas:", 38, "traped_gas", "did you mean 'trapped_gas'?"},
    {"{adiabatic: true", "{adiabatc: true", 38, "trapped_gas.adiabatc", "did you mean 'adiabatic'?"},
    {"time:", "times:", 39, "times", "did you mean 'time'?"},
    {"{end: 1 s", "{end_time: 1 s", 39, "time.end_time", "allowed keys are end, step, cfl"},
    {"cfl: 0.5", "CFL: 0.5", 39, "time.CFL", "did you mean 'cfl'?"},
    {"max_step", "maxstep", 39, "time.maxstep", "did you mean 'max_step'?"},
    {"  - until", "  - unitl", 41, "stages[0].unitl", "did you mean 'until'?"},
    {"regrid: {bubble_cells", "regrid: {bubble_cels", 43, "regrid.bubble_cels", "did you mean 'bubble_cells'?"},
    {"liquid_threshold", "liquid_treshold", 44, "solver.liquid_treshold", "did you mean 'liquid_threshold'?"},
    {"halvings", "halfings", 45, "guard.halfings", "did you mean 'halvings'?"},
    {"  directory", "  folder", 47, "output.folder", "allowed keys are directory, fields"},
    {"{every: 50 ms}", "{interval: 50 ms}", 48, "output.fields.interval", "allowed keys are every, times"},
    {"wall_interval", "wall_intervall", 49, "output.checkpoint.wall_intervall", "did you mean 'wall_interval'?"},
    {"  history", "  histroy", 50, "output.histroy", "did you mean 'history'?"},
    {"level: -0.5", "levle: -0.5", 51, "output.crater.levle", "did you mean 'level'?"},
};
TEST(BadCases, Keys) {
  for (const Bad& bad : keys) expect_refused(bad);
}

const Bad values[] = {
    {"title: A bubble under mud", "title: ''", 1, "title", "must not be empty"},
    {"title: A bubble under mud", "title: {a: 1}", 1, "title", "must be text, not a mapping"},
    {"title: A bubble under mud", "title: ~", 1, "title", "must be text, not nothing"},
    {"units: SI", "units: si", 2, "units", "did you mean 'SI'?"},
    {"units: SI", "units: cgs", 2, "units", "must be one of SI, none, not 'cgs'"},
    {"units: SI", "units: [SI]", 2, "units", "must be one of SI, none, not a list"},
    {"units: SI", "units: none", 6, "grid.x[0].to", "takes a plain number where units are none"},
    {"dimension: 2", "dimension: 1", 4, "grid.dimension", "must be from 2 to 3, not 1"},
    {"dimension: 2", "dimension: 2D", 4, "grid.dimension", "must be a whole number from 2 to 3, not '2D'"},
    {"dimension: 2", "dimension: 2.0", 4, "grid.dimension", "must be a whole number"},
    {"dimension: 2", "dimension: [2]", 4, "grid.dimension", "must be a whole number, not a list"},
    {"dimension: 2", "dimension:", 4, "grid.dimension", "must be a whole number, not nothing"},
    {"dimension: 2", "dimension: 3", 4, "grid.y", "is required but missing"},
    {"geometry: planar", "geometry: cylindrical", 5, "grid.geometry", "must be one of planar, axisymmetric"},
    {"geometry: planar", "geometry: axisymmetric", 9, "boundaries.x_min", "must be axis"},
    {"to: 1 m, cells: 20", "to: 1 meeter, cells: 20", 6, "grid.x[0].to", "unknown unit 'meeter'"},
    {"to: 1 m, cells: 20", "to: 1 kg, cells: 20", 6, "grid.x[0].to", "but the unit 'kg' is a mass"},
    {"to: 1 m, cells: 20", "to: 1 m^2, cells: 20", 6, "grid.x[0].to", "must be a length (such as m)"},
    {"to: 1 m, cells: 20", "to: one, cells: 20", 6, "grid.x[0].to", "must be a length (such as m) or a number"},
    {"to: 1 m, cells: 20", "to: 1e400, cells: 20", 6, "grid.x[0].to", "within the range of doubles"},
    {"to: 1 m, cells: 20", "to: 1e308 km, cells: 20", 6, "grid.x[0].to", "must be finite"},
    {"to: 1 m, cells: 20", "to: .nan, cells: 20", 6, "grid.x[0].to", "must be finite"},
    {"to: 1 m, cells: 20", "to: -.inf, cells: 20", 6, "grid.x[0].to", "must be finite"},
    {"to: 1 m, cells: 20", "to: 0x10, cells: 20", 6, "grid.x[0].to", "unit"},
    {"to: 1 m, cells: 20", "to: 1_000, cells: 20", 6, "grid.x[0].to", "must be a length"},
    {"to: 1 m, cells: 20", "to: '', cells: 20", 6, "grid.x[0].to", "must be a length"},
    {"to: 1 m, cells: 20", "to: 1 m/, cells: 20", 6, "grid.x[0].to", "unit is incomplete"},
    {"to: 1 m, cells: 20", "to: 1 m^99, cells: 20", 6, "grid.x[0].to", "small whole number"},
    {"to: 1 m, cells: 20", "to: 1 m*/s, cells: 20", 6, "grid.x[0].to", "must stand between two units"},
    {"to: 1 m, cells: 20", "to: 1 m%, cells: 20", 6, "grid.x[0].to", "unexpected '%'"},
    {"to: 1 m, cells: 20", "to: 1:30, cells: 20", 6, "grid.x[0].to", "must be a length"},
    {"to: 1 m, cells: 20", "to: -1, cells: 20", 6, "grid.x[0].to", "must be greater than from = 0, not -1"},
    {"cells: 20", "cells: -20", 6, "grid.x[0].cells", "must be from 1 to 1000000, not -20"},
    {"cells: 20", "cells: 2000000", 6, "grid.x[0].cells", "must be from 1 to 1000000"},
    {"cells: 20", "cells: 99999999999999999999999", 6, "grid.x[0].cells", "must be from 1 to 1000000"},
    {"cells: 20", "cells: 2e1", 6, "grid.x[0].cells", "must be a whole number"},
    {"cells: 20", "cells: 20 cells", 6, "grid.x[0].cells", "must be a whole number"},
    {"cells: 20", "cells: 1000000", 6, "grid.x", "has 1000010 cells; at most"},
    {"cells: 40}", "cells: 1000000}", 43, "regrid.bubble_cells", "asks for about"},
    {"stretch: smooth", "stretch: exponential", 6, "grid.x[1].stretch", "must be one of uniform, smooth"},
    {"cells: 20}", "cells: 20, stretch: smooth}", 6, "grid.x", "needs exactly one uniform segment beside it"},
    {"{to: 2, cells: 10", "{to: 2, cells: 2", 6, "grid.x", "use more cells"},
    {"{to: 2, cells: 10", "{to: 1 m, cells: 10", 6, "grid.x[1].to", "must be greater than from = 1"},
    {"z: {from: -1 m, to: 1 m, cells: 40}", "z: 40", 7, "grid.z", "must be a mapping of keys, not '40'"},
    {"z: {from: -1 m, to: 1 m, cells: 40}", "z: [-1, 1]", 7, "grid.z[0]", "must be a mapping of keys"},
    {"x_min: symmetry", "x_min: wall", 9, "boundaries.x_min", "must be one of axis, symmetry, free_slip, no_slip"},
    {"x_min: symmetry", "x_min: no-slip", 9, "boundaries.x_min", "did you mean 'no_slip'?"},
    {"x_min: symmetry", "x_min: axis", 9, "boundaries.x_min", "axis is for x_min of an axisymmetric grid"},
    {"x_min: symmetry", "x_min:", 9, "boundaries.x_min", "not nothing"},
    {"x_min: symmetry", "x_min: [symmetry]", 9, "boundaries.x_min", "not a list"},
    {"x_min: symmetry", "x_min: inflow", 9, "boundaries.x_min", "{inflow: {velocity: VELOCITY}}"},
    {"x_min: symmetry", "x_min: periodic", 10, "boundaries.x_max", "must be periodic as x_min is"},
    {"{no_slip: [0, 0]}", "{no_slip: 1}", 10, "boundaries.x_max.no_slip", "must be a vector"},
    {"{no_slip: [0, 0]}", "{no_slip: [0, 0, 0, 0]}", 10, "boundaries.x_max.no_slip", "not 4 numbers"},
    {"{no_slip: [0, 0]}", "{no_slip: [0, 1 kg]}", 10, "boundaries.x_max.no_slip[1]", "must be a velocity"},
    {"{no_slip: [0, 0]}", "{inflow: {velocity: [-1, 0], profile: cubic}}", 10, "boundaries.x_max.inflow.profile",
     "must be one of uniform, parabolic"},
    {"{no_slip: [0, 0]}", "{inflow: 1}", 10, "boundaries.x_max.inflow", "must be a mapping of keys"},
    {"{no_slip: [0, 0]}", "{no_slip: [0, 0], open: 1}", 10, "boundaries.x_max.no_slip", "unknown key"},
    {"{open: 1 atm}", "{open: 1 m}", 12, "boundaries.z_max.open", "but the unit 'm' is a length"},
    {"{open: 1 atm}", "{open: vacuum}", 12, "boundaries.z_max.open", "must be a pressure or stress"},
    {"{open: 1 atm}", "{open: 2 atm}", 12, "boundaries.z_max.open", "must be ambient_pressure"},
    {"{open: 1 atm}", "{open: 2 atm, outside: oil}", 12, "boundaries.z_max.outside",
     "'oil' is not a species; they are mud, water"},
    {"gravity: 9.81 m/s^2", "gravity: 9.81 m/s", 13, "gravity", "must be an acceleration"},
    {"gravity: 9.81 m/s^2", "gravity: down", 13, "gravity", "must be an acceleration"},
    {"gravity: 9.81 m/s^2", "gravity: [0, 0, 0, 9.81]", 13, "gravity", "must be a vector"},
    {"gravity: 9.81 m/s^2", "gravity: []", 13, "gravity", "must be a vector"},
    {"gravity: 9.81 m/s^2", "gravity: 9,81", 13, "gravity", "must be an acceleration"},
    {"ambient_pressure: 1 atm", "ambient_pressure: 1 atn", 14, "ambient_pressure", "unknown unit 'atn'"},
    {"name: mud", "name: 2mud", 16, "species[0].name", "not begin with a digit"},
    {"name: mud", "name: wet mud", 16, "species[0].name", "letters, digits and _"},
    {"name: mud", "name: Schl\xc3\xa4mme", 16, "species[0].name", "letters, digits and _"},
    {"name: mud", "name: water", 20, "species[1].name", "is the name of another species too"},
    {"density: 1500 kg/m^3", "density: 1500 kg", 17, "species[0].density", "must be a density"},
    {"density: 1500 kg/m^3", "density: -1500", 17, "species[0].density", "must be greater than 0, not -1500"},
    {"density: 1500 kg/m^3", "density: heavy", 17, "species[0].density", "must be a density"},
    {"law: bingham", "law: binghma", 18, "species[0].rheology.law", "did you mean 'bingham'?"},
    {"law: bingham", "law: Bingham", 18, "species[0].rheology.law", "did you mean 'bingham'?"},
    {"law: bingham", "law: [bingham]", 18, "species[0].rheology.law", "must be one of"},
    {"{law: bingham, viscosity: 1 Pa s, yield_stress: 100 Pa}", "bingham", 18, "species[0].rheology",
     "must be a mapping of keys, not 'bingham'"},
    {"viscosity: 1 Pa s", "viscosity: 1 Pa", 18, "species[0].rheology.viscosity", "must be a viscosity (such as Pa s)"},
    {"viscosity: 1 Pa s", "viscosity: -1", 18, "species[0].rheology.viscosity", "must be at least 0, not -1"},
    {"viscosity: 1 Pa s, ", "", 18, "species[0].rheology.viscosity", "is required but missing: viscosity above"},
    {"yield_exponent: 2", "yield_exponent: -2", 19, "species[0].concentration.yield_exponent", "must be at least 0"},
    {"fill: mud", "fill: sand", 24, "initial[0].fill", "'sand' is not a species; they are mud, water"},
    {"fill: mud", "fill: [mud]", 24, "initial[0].fill", "must be text, not a list"},
    {"shape: {layer: {bottom: -1 m, top: -0.5 m}}", "shape: layer", 25, "initial[0].shape",
     "must be a mapping of keys"},
    {"shape: {layer: {bottom: -1 m, top: -0.5 m}}", "shape: {}", 25, "initial[0].shape", "must have exactly one key"},
    {"top: -0.5 m", "top: -2 m", 25, "initial[0].shape.layer.top", "must be greater than bottom = -1"},
    {"bottom: -1 m", "bottom: -3 m", 25, "initial[0].shape", "reaches beyond the grid: to z = -3"},
    {"top: -0.5 m", "top: 0.2 m", 27, "initial[1].shape", "overlaps initial[0].shape (case.yaml:25"},
    {"{layer: {bottom: -1 m, top: -0.5 m}}", "{layer: {bottom: -1 m, top: -0.5 m}, box: {}}", 25, "initial[0].shape",
     "must have exactly one key, one of box, layer"},
    {"to: [2, 0.5]", "to: [2, 0.5, 0, 1]", 27, "initial[1].shape.box.to", "must be a vector"},
    {"to: [2, 0.5]", "to: [2]", 27, "initial[1].shape.box.to", "not 1 numbers"},
    {"to: [2, 0.5]", "to: [-2, 0.5]", 27, "initial[1].shape.box.to", "must be greater than from in x"},
    {"{box: {from: [0, -0.5], to: [2, 0.5]}}", "{polygon: {points: [[0, 0], [1, 0]]}}", 27,
     "initial[1].shape.polygon.points", "needs at least 3 items"},
    {"{box: {from: [0, -0.5], to: [2, 0.5]}}", "{polygon: {points: [[0, 0], [1, 0], [2, 0]]}}", 27,
     "initial[1].shape.polygon.points", "must enclose an area"},
    {"{box: {from: [0, -0.5], to: [2, 0.5]}}", "{polygon: {points: [[0, 0], [1, 0.4], [1, 0], [0, 0.4]]}}", 27,
     "initial[1].shape.polygon.points", "cross"},
    {"{box: {from: [0, -0.5], to: [2, 0.5]}}", "{polygon: {points: [[0, 0], [1, 0], 3]}}", 27,
     "initial[1].shape.polygon.points[2]", "must be a point [x, z]"},
    {"{box: {from: [0, -0.5], to: [2, 0.5]}}", "{half_space: {point: [0, 0], normal: [0, 0]}}", 27,
     "initial[1].shape.half_space.normal", "must not be zero"},
    {"{box: {from: [0, -0.5], to: [2, 0.5]}}", "{wave: {level: 0, amplitude: 0.1, wavenumber: 1}}", 27,
     "initial[1].shape.wave", "give either bottom"},
    {"{box: {from: [0, -0.5], to: [2, 0.5]}}", "{wave: {bottom: 0, level: 0, amplitude: 0.1, wavenumber: 1}}", 27,
     "initial[1].shape.wave.bottom", "must lie below the trough"},
    {"{box: {from: [0, -0.5], to: [2, 0.5]}}", "{sphere: {center: [1, 0], radius: 5}}", 27, "initial[1].shape",
     "reaches beyond the grid"},
    {"radius: 20 cm", "radius: -20 cm", 30, "bubbles[0].radius", "must be greater than 0"},
    {"radius: 20 cm", "radius: 3 m", 30, "bubbles[0]", "reaches beyond the grid"},
    {"pressure: 2 atm", "pressure: 0", 30, "bubbles[0].pressure", "must be greater than 0"},
    {"{center: [0, 0]", "{center: [0.1, 0]", 30, "bubbles[0].center", "must lie on the plane of symmetry"},
    {"{center: [0, 0]", "{center: [0, 5]", 30, "bubbles[0].center", "must lie within the grid, z from -1 to 1"},
    {"{center: [0, 0]", "{center: [0, 0.6]", 30, "bubbles[0]", "must lie in liquid"},
    {"mass: 1 g", "mass: 1 N", 33, "charges[0].mass", "must be a mass"},
    {"mass: 1 g", "mass: 0", 33, "charges[0].mass", "must be greater than 0"},
    {"    mass: 1 g\n", "", 32, "charges[0].mass", "is required but missing: mass of the whole charge"},
    {"radius_constant: 11", "radius_constant: 11 ft", 34, "charges[0].radius_constant", "must be a plain number"},
    {"minimum_radius_constant: 0.272", "minimum_radius_constant: 27.2", 32, "charges[0]", "would not expand"},
    {"    thickness: 1 m\n", "", 32, "charges[0].thickness", "is required but missing: in planar cases"},
    {"adiabatic: true", "adiabatic: yes", 38, "trapped_gas.adiabatic", "must be true or false, not 'yes'"},
    {"adiabatic: true", "adiabatic: 1", 38, "trapped_gas.adiabatic", "must be true or false, not '1'"},
    {"end: 1 s", "end: -1 s", 39, "time.end", "must be greater than 0"},
    {"end: 1 s", "end: 1 sek", 39, "time.end", "unknown unit 'sek'"},
    {"end: 1 s, ", "", 39, "time.end", "is required but missing: when the run ends"},
    {"end: 1 s", "end: forever", 39, "time.end", "must be a time"},
    {"cfl: 0.5", "cfl: 50 %", 39, "time.cfl", "must be a plain number"},
    {"cfl: 0.5", "cfl: 2", 39, "time.cfl", "greater than 0 and at most 1, not 2"},
    {"min_step: 1e-9", "min_step: 1", 39, "time.min_step", "must not be greater than max_step"},
    {"until: 0.5 s", "until: 5 s", 41, "stages[0].until", "must be before the end of the run, 1"},
    {"x: {from: 0, to: 2, cells: 30}", "x: {from: 0, to: 3, cells: 30}", 42, "stages[0].grid.x",
     "must go from 0 to 2 as the case's grid does"},
    {"regrid: {bubble_cells: 8}", "regrid: 8", 43, "regrid", "must be a mapping of keys, not '8'"},
    {"bubble_cells: 8", "bubble_cells: 2", 43, "regrid.bubble_cells", "must be from 4 to 1000, not 2"},
    {"mass: 1 g", "mass: 1e-15 g", 43, "regrid.bubble_cells", "less than a millionth of the grid's length"},
    {"tolerance: 1e-9", "tolerance: 0", 44, "solver.tolerance", "greater than 0 and at most 0.1"},
    {"max_iterations: 500", "max_iterations: 0", 44, "solver.max_iterations", "must be at least 1, not 0"},
    {"max_iterations: 500", "max_iterations: 1e3", 44, "solver.max_iterations", "must be a whole number at least 1"},
    {"halvings: 8", "halvings: 100", 45, "guard.halvings", "must be from 0 to 50, not 100"},
    {"volume_error: 1e-9", "volume_error: 1e-20", 45, "guard.volume_error", "at least 1.0e-13 and at most 1"},
    {"directory: results/test", "directory: [a]", 47, "output.directory", "must be text, not a list"},
    {"every: 50 ms", "every: 50 m", 48, "output.fields.every", "must be a time"},
    {"{every: 50 ms}", "{times: 0.1}", 48, "output.fields.times", "must be a list, not '0.1'"},
    {"{every: 50 ms}", "{times: []}", 48, "output.fields.times", "needs at least 1 item"},
    {"{every: 50 ms}", "{times: [0.1, later]}", 48, "output.fields.times[1]", "must be a time"},
    {"{every: 50 ms}", "{times: [-1]}", 48, "output.fields.times[0]", "must be at least 0, not -1"},
    {"{every: 50 ms}", "50 ms", 48, "output.fields", "must be a mapping of keys, not '50 ms'"},
    {"wall_interval: 900", "wall_interval: 0", 49, "output.checkpoint.wall_interval", "must be greater than 0"},
    {"history: true", "history: 'true'", 50, "output.history", "must be true or false"},
    {"crater: {species: mud", "crater: {species: {mud: 1}", 51, "output.crater.species", "must be text"},
    {"level: -0.5", "level: -5", 51, "output.crater.level", "must lie within the grid"},
};
TEST(BadCases, Values) {
  for (const Bad& bad : values) expect_refused(bad);
}

const Bad sections[] = {
    {"species:\n", "species: []\nspecies_:\n", 15, "species", "needs at least 1 item"},
    {"species:\n", "species: mud\nspecies_:\n", 15, "species", "must be a list, not 'mud'"},
    {"  - name: mud\n", "  - 1\n  - name: mud\n", 16, "species[0]", "must be a mapping of keys, not '1'"},
    {"  - name: mud\n", "  -\n  - name: mud\n", 17, "species[0]", "must be a mapping of keys, not nothing"},
    {"bubbles:\n", "bubbles: {radius: 1}\nbubbles_:\n", 29, "bubbles", "must be a list, not a mapping"},
    {"charges:\n", "charges: none\ncharges_:\n", 31, "charges", "must be a list, not 'none'"},
    {"time: {end: 1 s, cfl: 0.5, max_step: 10 ms, min_step: 1e-9}", "time: 1 s", 39, "time",
     "must be a mapping of keys"},
    {"initial:\n", "initial:\n  box: 1\ninitial_:\n", 24, "initial", "must be a list, not a mapping"},
};
TEST(BadCases, Sections) {
  for (const Bad& bad : sections) expect_refused(bad);
}

TEST(BadCases, AreMany) {
  EXPECT_EQ(error_of(full_case), "");
  EXPECT_GE(std::size(syntax) + std::size(keys) + std::size(values) + std::size(sections), 200u);
}

TEST(BadCases, EveryMisspeltKeyGetsItsName) {
  for (const KeyDescription& key : list_keys(case_codec().schema)) {
    const std::size_t dot = key.path.rfind('.');
    const std::string name = key.path.substr(dot + 1);
    if (dot != std::string::npos || name.size() < 4) continue;
    std::string misspelt = name;
    std::swap(misspelt[1], misspelt[2]);
    if (misspelt == name) misspelt.erase(1, 1);
    const std::string error = error_of(full_case + misspelt + ": 1\n");
    EXPECT_NE(error.find(": " + misspelt + ": unknown key; did you mean '" + name + "'?"), std::string::npos) << error;
  }
}

std::string error_of_bytes(const std::string& bytes) {
  const std::string file = testing::TempDir() + "quicksand_bad.yaml";
  std::ofstream(file, std::ios::binary) << bytes;
  std::string message;
  try {
    read_case(file);
  } catch (const InputError& error) {
    message = error.what();
  }
  std::filesystem::remove(file);
  return message;
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(BadCases, BytesThatAreNoText) {
  EXPECT_NE(error_of_bytes(""), "");
  EXPECT_NE(error_of_bytes("\n\n\n"), "");
  EXPECT_NE(error_of_bytes("\xff\xfe" + full_case), "");
  EXPECT_NE(error_of_bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR"), "");
  EXPECT_NE(error_of_bytes(std::string("\x7f"
                                       "ELF\x02\x01\x01\0\0",
                                       9)),
            "");
  EXPECT_NE(error_of_bytes(with("name: mud",
                                "name: m\xfc"
                                "d",
                                full_case)),
            "");
  EXPECT_NE(error_of_bytes("%YAML 1\n---\n" + full_case), "");
}

TEST(BadCases, EndingsOfLinesAndByteOrderMarksAreNoMistakes) {
  std::string windows;
  for (const char ch : full_case) windows += ch == '\n' ? std::string("\r\n") : std::string(1, ch);
  EXPECT_EQ(error_of_bytes(windows), "");
  EXPECT_EQ(error_of_bytes("\xef\xbb\xbf" + full_case), "");
}

TEST(BadCases, HugeAndDeepTextIsRefused) {
  const std::vector<std::string> texts = {
      repeated("[", 200000),
      repeated("{a: ", 100000),
      repeated("- ", 100000),
      "a: " + repeated("[[", 300) + repeated("]]", 300) + "\n",
      "a: &a [x, x, x, x, x, x, x, x, x]\nb: &b [*a, *a, *a, *a, *a, *a, *a]\nc: [*b, *b, *b, *b, *b, *b]\n",
      "a: &a\n  <<: *a\n",
      repeated("key: value\n", 20000),
      "title: " + std::string(1000000, 'x') + "\n",
      std::string(1000000, 'x') + ": 1\n",
      "title: " + repeated("'", 100001) + "\n",
      with("species:", "x" + std::string(10000, 'y') + ": 1\nspecies:", full_case),
      with("cells: 20", "cells: " + std::string(100000, '9'), full_case),
      with("to: 1 m", "to: " + std::string(100000, '1'), full_case),
      with("to: 1 m", "to: 1 " + repeated("m*", 20000) + "m", full_case),
  };
  // One that hangs runs into the test's time limit.
  for (const std::string& text : texts) EXPECT_NE(error_of(text), "") << text.substr(0, 40);
}

}  // namespace
}  // namespace quicksand
