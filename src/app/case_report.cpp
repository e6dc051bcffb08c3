#include "app/case_report.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

#include "app/build_flow.hpp"
#include "app/grid_sequence.hpp"
#include "app/initial_bubbles.hpp"
#include "app/time_control.hpp"
#include "core/config_node.hpp"
#include "core/snapshot.hpp"
#include "physics/time_step.hpp"

namespace quicksand {

namespace {

/// Estimate of the doubles that a run holds per cell, solver hierarchies included: a base, per axis and per species.
constexpr double base_fields = 60;
constexpr double fields_per_axis = 30;
constexpr double fields_per_species = 10;

/// Megabytes of a case up to which its flow is built to find the first step; larger ones take too long.
constexpr double most_memory_to_build = 500;

/// Cells between liquid and an open side below which a case is suspect.
constexpr int least_air_cells = 2;

/// Short text of a number for reading, with four digits.
std::string brief(double value) {
  std::ostringstream out;
  out << std::setprecision(4) << value;
  return out.str();
}

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

template <int Dim>
struct InitialState {
  Grid<Dim> grid;
  std::vector<double> volumes;  ///< per fill
  CellField liquid;             ///< sum of fractions
};

/// The start on the first grid of the run.
template <int Dim>
InitialState<Dim> fill_cells(const CaseConfig& config) {
  Grid<Dim> grid = GridSequence<Dim>(config).first().grid;
  InitialState<Dim> state{std::move(grid), {}, {}};
  state.liquid = CellField(state.grid.layout());
  const Box<Dim> cells = state.grid.cells();
  const std::vector<InitialBubble> bubbles = initial_bubbles(config);
  for (const InitialFill& fill : config.initial) {
    CellField phi(state.grid.layout());
    for_each_indexed<Cell>(state.grid.layout(), cells, [&](Cell c, const Index<Dim>& i) {
      phi[c] = fraction(fill.shape, state.grid, i);
      for (const InitialBubble& bubble : bubbles) {
        phi[c] *= 1 - fraction(SphereShape{bubble.center, bubble.radius}, state.grid, i);
      }
      state.liquid[c] += phi[c];
    });
    state.volumes.push_back(
        sum<Cell>(state.grid.layout(), cells, [&](Cell c) { return phi[c] * state.grid.volume(c); }));
  }
  return state;
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

/// Estimate of the megabytes that a run needs.
double needed_memory(const CaseConfig& config) {
  double most_cells = 0;
  const auto count = [&](const GridConfig& grid) {
    double cells = 1;
    for (const long n : axis_cells(grid)) cells *= static_cast<double>(n + 2 * ghosts);
    most_cells = std::max(most_cells, cells);
  };
  count(config.grid);
  for (const StageConfig& stage : config.stages) count(grid_of(config, stage));
  const double fields = base_fields + fields_per_axis * config.grid.dimension +
                        fields_per_species * static_cast<double>(config.species.size());
  // On its way from one grid to the next a flow is there twice.
  const double flows = config.stages.empty() && !config.regrid ? 1 : 2;
  return flows * fields * sizeof(double) * most_cells / 1e6;
}

double machine_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE)) / 1e6;
}

/// Whether a grid of the case may be allocated.
bool fits(const CaseConfig& config) { return needed_memory(config) <= machine_memory(); }

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
  return text + "; first " + brief(first_step<Dim>(config));
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

/// Whether liquid begins within a few cells of a side.
template <int Dim>
bool liquid_near(const InitialState<Dim>& state, int d, int side) {
  Box<Dim> layer = state.grid.cells();
  if (side == 0) {
    layer.hi[d] = std::min(layer.hi[d], least_air_cells);
  } else {
    layer.lo[d] = std::max(layer.lo[d], layer.hi[d] - least_air_cells);
  }
  return maximum<Cell>(state.grid.layout(), layer, 0.0, [&](Cell c) { return state.liquid[c]; }) > 0;
}

/// Bubbles of a radius of fewer cells are not resolved.
constexpr int least_bubble_cells = 4;

/// Width of the widest cell along any axis that a bubble's middle lies in or beside.
template <int Dim>
double width_around(const Grid<Dim>& grid, const InitialBubble& bubble) {
  const Vec<Dim> center = in_axes<Dim>(bubble.center);
  double widest = 0;
  for (int d = 0; d < Dim; ++d) {
    int i = 0;
    while (i + 1 < grid.owned_cells()[d] && grid.face_position(d, i + 1) < center[d]) ++i;
    widest = std::max(widest, grid.width_1d(d, i));
  }
  return widest;
}

template <int Dim>
std::vector<std::string> bubble_warnings(const CaseConfig& config, const Grid<Dim>& grid) {
  std::vector<std::string> found;
  const std::vector<InitialBubble> bubbles = initial_bubbles(config);
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const double cells = bubbles[i].radius / width_around(grid, bubbles[i]);
    if (cells >= least_bubble_cells) continue;
    const std::size_t given = config.bubbles.size();
    const std::string path = i < given ? child_path("bubbles", i) : child_path("charges", i - given);
    found.push_back(path + ": the " + (i < given ? "" : "minimum ") + "radius is " + brief(cells) +
                    " cells; fewer than " + std::to_string(least_bubble_cells) + " do not resolve it");
  }
  return found;
}

template <int Dim>
std::vector<std::string> warnings(const CaseConfig& config) {
  if (!fits(config)) {
    return {"the run needs about " + brief(needed_memory(config)) + " MB of memory, and this machine has " +
            brief(machine_memory()) + " MB"};
  }
  std::vector<std::string> found;
  const InitialState<Dim> state = fill_cells<Dim>(config);
  for (std::size_t i = 0; i < config.initial.size(); ++i) {
    if (state.volumes[i] <= 0)
      found.push_back("initial[" + std::to_string(i) + "]: the shape fills nothing of the grid");
  }
  for (const Species& species : config.species) {
    const bool used = std::any_of(config.initial.begin(), config.initial.end(),
                                  [&](const InitialFill& fill) { return fill.fill == species.name; });
    if (!used) found.push_back("species " + species.name + " is not present at the start");
  }
  for (std::string& text : bubble_warnings(config, state.grid)) found.push_back(std::move(text));
  const Sides<Dim> sides = make_sides<Dim>(config);
  const char* axes = Dim == 3 ? "xyz" : "xz";
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (!is_open(sides.at(d, s)) || sides.at(d, s).outside) continue;
      const std::string name = std::string(1, axes[d]) + (s == 0 ? "_min" : "_max");
      if (liquid_near(state, d, s)) {
        found.push_back("liquid begins less than " + std::to_string(least_air_cells) + " cells from the open side " +
                        name);
      }
    }
  }
  return found;
}

}  // namespace

std::string case_report(const CaseConfig& config) {
  return config.grid.dimension == 3 ? report<3>(config) : report<2>(config);
}

std::vector<std::string> case_warnings(const CaseConfig& config) {
  return config.grid.dimension == 3 ? warnings<3>(config) : warnings<2>(config);
}

}  // namespace quicksand
