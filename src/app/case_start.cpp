#include "app/case_start.hpp"

#include <unistd.h>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

#include "app/grid_sequence.hpp"
#include "app/initial_bubbles.hpp"
#include "physics/diffusion.hpp"

namespace quicksand {

namespace {

/// Estimate of the doubles that a run holds per cell, solver hierarchies included: a base and per species.
constexpr double base_fields = 46;
constexpr double fields_per_species = 7;
/// What liquids with a yield stress or a viscosity that varies take besides: the law, the matrix with the hierarchies
/// of its blocks, and stresses at the points of every element, three times where they are rigid.
constexpr double law_fields = 10;
template <int Dim>
constexpr double matrix_fields = Dim == 2 ? 19 : 123;
constexpr double hierarchy_fields = 18;
template <int Dim>
constexpr double stress_fields = 1.0 * sizeof(PointStresses<Dim>) / sizeof(double);

template <int Dim>
double stress_memory(const std::vector<Species>& species) {
  double fields = 0;
  for (const Species& s : species) {
    const Rheology law = rheology(s.law);
    const double stresses = law.rigid_yield_stress > 0 ? 3 : law.is_nonlinear() ? 1 : 0;
    if (stresses == 0) continue;
    const double whole = law_fields + matrix_fields<Dim> + Dim * hierarchy_fields + stresses * stress_fields<Dim>;
    fields = std::max(fields, whole);
  }
  return fields;
}

/// Cells of a grid with its ghosts.
double allocated_cells(const GridConfig& grid) {
  double cells = 1;
  for (const long n : axis_cells(grid)) cells *= static_cast<double>(n + 2 * ghosts);
  return cells;
}

}  // namespace

double needed_memory(const CaseConfig& config) {
  double most_cells = std::max(allocated_cells(config.grid), first_grid_cells(config));
  for (const StageConfig& stage : config.stages) {
    most_cells = std::max(most_cells, allocated_cells(grid_of(config, stage)));
  }
  const double fields =
      base_fields + fields_per_species * static_cast<double>(config.species.size()) +
      (config.grid.dimension == 2 ? stress_memory<2>(config.species) : stress_memory<3>(config.species));
  // On its way from one grid to the next a flow is there twice.
  const double flows = config.stages.empty() && !config.regrid ? 1 : 2;
  return flows * fields * sizeof(double) * most_cells / 1e6;
}

double machine_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE)) / 1e6;
}

bool fits(const CaseConfig& config) { return needed_memory(config) <= machine_memory(); }

template <int Dim>
InitialState<Dim> fill_cells(const CaseConfig& config) {
  Grid<Dim> grid = GridSequence<Dim>(config).first().grid;
  InitialState<Dim> state{std::move(grid), {}, {}};
  state.liquid = CellField(state.grid.layout());
  const Box<Dim> cells = state.grid.cells();
  const std::vector<InitialBubble> bubbles = initial_bubbles(config);
  for (const InitialFill& fill : config.initial) {
    CellField phi(state.grid.layout());
    for_each<Cell>(state.grid.layout(), cells, [&](Cell c, const Index<Dim>& i) {
      phi[c] = fraction(fill.shape, state.grid, i);
      for (const InitialBubble& bubble : bubbles) {
        phi[c] *= 1 - fraction(SphereShape{bubble.center, bubble.radius}, state.grid, i);
      }
      state.liquid[c] += phi[c];
    });
    state.volumes.push_back(sum<Cell>(state.grid.layout(), cells,
                                      [&](Cell c, const Index<Dim>& i) { return phi[c] * state.grid.volume(i); }));
  }
  return state;
}

std::string brief(double value) {
  std::ostringstream out;
  out << std::setprecision(4) << value;
  return out.str();
}

template InitialState<2> fill_cells<2>(const CaseConfig&);
template InitialState<3> fill_cells<3>(const CaseConfig&);

}  // namespace quicksand
