#include "app/case_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

#include "app/build_flow.hpp"
#include "app/case_start.hpp"
#include "app/grid_sequence.hpp"
#include "app/initial_bubbles.hpp"
#include "app/time_control.hpp"
#include "core/config_node.hpp"
#include "core/errors.hpp"
#include "core/snapshot.hpp"
#include "physics/time_step.hpp"

namespace quicksand {

namespace {

/// Megabytes of a case up to which its flow is built to find the first step; larger ones take too long.
constexpr double most_memory_to_build = 500;

std::string law_text(const Law& law) {
  struct Printer {
    std::string operator()(const Inviscid&) const { return "inviscid"; }
    std::string operator()(const Newtonian& l) const { return "newtonian, viscosity " + shortest(l.viscosity); }
    std::string operator()(const Bingham& l) const {
      return "bingham, viscosity " + shortest(l.viscosity) + ", yield stress " + shortest(l.yield_stress);
    }
    std::string operator()(const HerschelBulkley& l) const {
      return "herschel_bulkley, consistency " + shortest(l.consistency) + ", index " + shortest(l.index) +
             ", yield stress " + shortest(l.yield_stress) + ", regularization " + shortest(l.regularization);
    }
    std::string operator()(const Casson& l) const {
      return "casson, viscosity " + shortest(l.viscosity) + ", yield stress " + shortest(l.yield_stress) +
             ", regularization " + shortest(l.regularization);
    }
    std::string operator()(const Papanastasiou& l) const {
      return "papanastasiou, viscosity " + shortest(l.viscosity) + ", yield stress " + shortest(l.yield_stress) +
             ", regularization " + shortest(l.regularization);
    }
  };
  return std::visit(Printer{}, law);
}

std::string bubbles_text(const CaseConfig& config) {
  std::ostringstream out;
  for (const InitialBubble& b : config.bubbles) {
    out << "bubble         radius " << shortest(b.radius) << ", pressure " << shortest(b.pressure)
        << ", adiabatic exponent " << shortest(b.adiabatic_exponent) << "\n";
  }
  return out.str();
}

/// Where the charges are and what becomes of them; with five digits, to compare with tables.
std::string charges_text(const CaseConfig& config) {
  const bool ball = geometry_of(config.grid) != Geometry::planar;
  std::ostringstream out;
  out << std::setprecision(5);
  for (const InitialCharge& charge : config.charges) {
    const PlacedCharge placed = place_charge(config, charge);
    const ExplosionBubble& bubble = placed.bubble;
    out << "charge         depth " << placed.depth << ", P_inf " << placed.p_inf << ", radius ratio "
        << bubble.radius_ratio << "\n               A_min " << bubble.minimum_radius << ", A_max "
        << bubble.maximum_radius << ", P_B0 " << bubble.initial_pressure << " = "
        << bubble.initial_pressure / placed.p_inf << " P_inf, least pressure " << bubble.least_pressure / placed.p_inf
        << " P_inf\n               free-field period ";
    if (ball) {
      out << free_field_period(bubble, charge.adiabatic_exponent, placed.p_inf, placed.density) << "\n";
    } else {
      out << "none (infinite for a cylinder of gas in unbounded liquid)\n";
    }
  }
  return out.str();
}

std::string cells_text(const std::vector<long>& cells) {
  std::string text;
  long product = 1;
  for (const long n : cells) {
    text += (text.empty() ? "" : " x ") + std::to_string(n);
    product *= n;
  }
  return text + " = " + std::to_string(product);
}

double smallest_width(const GridConfig& grid) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto* axis : {&grid.x, &grid.y, &grid.z}) {
    if (axis->empty()) continue;
    const std::vector<double> faces = make_faces(*axis);
    for (std::size_t i = 1; i < faces.size(); ++i) smallest = std::min(smallest, faces[i] - faces[i - 1]);
  }
  return smallest;
}

/// Volume over one radian to that of the whole body of revolution.
double full_turn(const GridConfig& grid) { return grid.geometry == Geometry::axisymmetric ? 2 * std::numbers::pi : 1; }

/// A line per species; with the volumes at the start where the grid fits into memory.
template <int Dim>
std::string species_text(const CaseConfig& config) {
  std::vector<double> volumes;
  if (fits(config)) volumes = fill_cells<Dim>(config).volumes;
  std::ostringstream out;
  for (const Species& species : config.species) {
    out << "species        " << species.name << ": density " << shortest(species.density) << ", "
        << law_text(species.law);
    double volume = 0;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
      if (config.initial[i].fill == species.name) volume += volumes[i];
    }
    if (!volumes.empty()) {
      out << "; initial volume " << brief(volume * full_turn(config.grid))
          << (Dim == 2 && config.grid.geometry == Geometry::planar ? " per unit of depth" : "");
    }
    out << "\n";
  }
  return out.str();
}

/// The first step by CFL number, as the run takes it.
template <int Dim>
double first_step(const CaseConfig& config) {
  const Flow<Dim> flow = build_flow<Dim>(config);
  TimeControl control(config.time, config.output.fields);
  control.output_due(0);
  return control.next_step(0, 0, stable_step(flow, control.cfl()));
}

template <int Dim>
std::string time_step_text(const CaseConfig& config) {
  const TimeSettings& time = config.time;
  if (time.step) return shortest(*time.step) + ", " + brief(std::ceil(time.end / *time.step - 1e-3)) + " steps";
  std::string text = "CFL number " + shortest(*time.cfl) + ", at most " + shortest(*time.max_step);
  if (needed_memory(config) > most_memory_to_build) return text;
  try {
    return text + "; first " + brief(first_step<Dim>(config));
  } catch (const NumericalError& error) {
    return text + "; the run can't begin: " + error.what();
  }
}

/// A line per stage, and one for the first grid where it is made to fit the bubbles.
template <int Dim>
std::string grids_text(const CaseConfig& config) {
  std::ostringstream out;
  if (config.regrid && fits(config)) {
    const Grid<Dim> grid = GridSequence<Dim>(config).first().grid;
    out << "first grid     " << cells_text({std::begin(grid.global_cells().v), std::end(grid.global_cells().v)})
        << ", smallest cell " << brief(grid.smallest_width()) << "\n";
  }
  for (const StageConfig& stage : config.stages) {
    const GridConfig grid = grid_of(config, stage);
    out << "stage          until " << shortest(stage.until) << ": " << cells_text(axis_cells(grid))
        << ", smallest cell " << brief(smallest_width(grid)) << "\n";
  }
  return out.str();
}

template <int Dim>
std::string report(const CaseConfig& config) {
  std::ostringstream out;
  out << "title          " << config.title << "\n"
      << "units          " << (config.units == UnitSystem::si ? "SI" : "none") << "\n"
      << "dimension      " << Dim << "\n"
      << "geometry       " << geometry_name(geometry_of(config.grid)) << "\n"
      << "cells          " << cells_text(axis_cells(config.grid)) << "\n"
      << "smallest cell  " << brief(smallest_width(config.grid)) << "\n"
      << grids_text<Dim>(config) << "memory         about " << brief(needed_memory(config)) << " MB\n"
      << species_text<Dim>(config) << bubbles_text(config) << charges_text(config) << "end of run     "
      << shortest(config.time.end) << "\n"
      << "time step      " << time_step_text<Dim>(config) << "\n"
      << "output folder  " << config.output.directory << "\n";
  return out.str();
}

}  // namespace

std::string case_report(const CaseConfig& config) {
  return config.grid.dimension == 3 ? report<3>(config) : report<2>(config);
}

}  // namespace quicksand
