#include "app/case_start.hpp"

#include <unistd.h>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>
#include <vector>

#include "app/grid_sequence.hpp"
#include "app/initial_bubbles.hpp"
#include "physics/diffusion.hpp"
#include "physics/velocity_solver.hpp"
#include "solvers/banded_cholesky.hpp"
#include "solvers/preconditioner.hpp"

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

/// Numbers per cell of banded factors, where a grid without periodic axes is slender enough for them.
double factor_fields(const GridConfig& grid, int components, int widest) {
  std::vector<long> cells = axis_cells(grid);
  std::sort(cells.begin(), cells.end());
  double points = 0;  // by which the numbers of neighbours differ
  double stride = 1;
  for (const long n : cells) {
    points += n > 1 ? stride : 0;
    stride *= static_cast<double>(n);
  }
  const double band = components * (points + 1) - 1;
  return band <= widest ? components * BandedCholesky::numbers_per_unknown(static_cast<int>(band)) : 0.0;
}

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
  const double stress =
      config.grid.dimension == 2 ? stress_memory<2>(config.species) : stress_memory<3>(config.species);
  const double scalar_factors = factor_fields(config.grid, 1, widest_scalar_band);
  const double velocity_factors =
      stress > 0 ? factor_fields(config.grid, config.grid.dimension, widest_velocity_band) : 0.0;
  const double fields = base_fields + fields_per_species * static_cast<double>(config.species.size()) + stress +
                        std::max(scalar_factors, velocity_factors);
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
