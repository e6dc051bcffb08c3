#include "app/case_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <type_traits>

#include "core/config_node.hpp"
#include "core/snapshot.hpp"

namespace quicksand {

namespace {

/// Estimate of the doubles that a run holds per cell, solver hierarchies included: a base, per axis and per species.
constexpr double base_fields = 60;
constexpr double fields_per_axis = 30;
constexpr double fields_per_species = 10;

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
    std::string operator()(const Papanastasiou& l) const {
      return "papanastasiou, viscosity " + shortest(l.viscosity) + ", yield stress " + shortest(l.yield_stress) +
             ", regularization " + shortest(l.regularization);
    }
  };
  return std::visit(Printer{}, law);
}

template <int Dim>
struct InitialState {
  Grid<Dim> grid;
  std::vector<double> volumes;  ///< per fill
  CellField liquid;             ///< sum of fractions
};

template <int Dim>
InitialState<Dim> fill_cells(const CaseConfig& config) {
  Grid<Dim> grid = make_grid<Dim>(config.grid);
  InitialState<Dim> state{std::move(grid), {}, {}};
  state.liquid = CellField(state.grid.layout());
  const Box<Dim> cells = state.grid.cells();
  for (const InitialFill& fill : config.initial) {
    CellField phi(state.grid.layout());
    for_each_indexed<Cell>(state.grid.layout(), cells, [&](Cell c, const Index<Dim>& i) {
      phi[c] = fraction(fill.shape, state.grid, i);
      state.liquid[c] += phi[c];
    });
    state.volumes.push_back(
        sum<Cell>(state.grid.layout(), cells, [&](Cell c) { return phi[c] * state.grid.volume(c); }));
  }
  return state;
}

template <int Dim>
std::string cells_text(const Grid<Dim>& grid) {
  std::string text;
  for (int d = 0; d < Dim; ++d) text += (d > 0 ? " x " : "") + std::to_string(grid.global_cells()[d]);
  return text + " = " + std::to_string(grid.cells().size());
}

/// Volume over one radian to that of the whole body of revolution.
double full_turn(const GridConfig& grid) { return grid.geometry == Geometry::axisymmetric ? 2 * std::numbers::pi : 1; }

template <int Dim>
std::string report(const CaseConfig& config) {
  const InitialState<Dim> state = fill_cells<Dim>(config);
  const double species_count = static_cast<double>(config.species.size());
  const double fields = base_fields + fields_per_axis * Dim + fields_per_species * species_count;
  const double megabytes = fields * sizeof(double) * static_cast<double>(state.grid.layout().size()) / 1e6;
  std::ostringstream out;
  out << "title          " << config.title << "\n"
      << "units          " << (config.units == UnitSystem::si ? "SI" : "none") << "\n"
      << "dimension      " << Dim << "\n"
      << "geometry       " << geometry_name(state.grid.geometry()) << "\n"
      << "cells          " << cells_text(state.grid) << "\n"
      << "smallest cell  " << brief(state.grid.smallest_width()) << "\n"
      << "memory         about " << brief(megabytes) << " MB\n";
  for (const Species& species : config.species) {
    double volume = 0;
    for (std::size_t i = 0; i < config.initial.size(); ++i) {
      if (config.initial[i].fill == species.name) volume += state.volumes[i];
    }
    out << "species        " << species.name << ": density " << shortest(species.density) << ", "
        << law_text(species.law) << "; initial volume " << brief(volume * full_turn(config.grid))
        << (Dim == 2 && config.grid.geometry == Geometry::planar ? " per unit of depth" : "") << "\n";
  }
  out << "end of run     " << shortest(config.time.end) << "\n";
  if (config.time.step) {
    out << "time step      " << shortest(*config.time.step) << ", "
        << brief(std::ceil(config.time.end / *config.time.step - 1e-9)) << " steps\n";
  } else {
    out << "time step      CFL number " << shortest(*config.time.cfl) << ", at most " << shortest(*config.time.max_step)
        << "\n";
  }
  out << "output folder  " << config.output.directory << "\n";
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

template <int Dim>
std::vector<std::string> warnings(const CaseConfig& config) {
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
  const Sides<Dim> sides = make_sides<Dim>(config);
  const char* axes = Dim == 3 ? "xyz" : "xz";
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (!is_open(sides.at(d, s))) continue;
      const std::string name = std::string(1, axes[d]) + (s == 0 ? "_min" : "_max");
      if (liquid_near(state, d, s)) {
        found.push_back("liquid begins less than " + std::to_string(least_air_cells) + " cells from the open side " +
                        name);
      }
      if (sides.at(d, s).pressure != config.ambient_pressure) {
        found.push_back("the pressure outside the open side " + name + ", " + shortest(sides.at(d, s).pressure) +
                        ", is not ambient_pressure, " + shortest(config.ambient_pressure));
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
