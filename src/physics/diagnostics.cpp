#include "physics/diagnostics.hpp"

#include <algorithm>
#include <cmath>

#include "physics/energy.hpp"

namespace quicksand {

namespace {

constexpr double surface_fraction = 0.5;
constexpr double liquid_fraction = 0.9;  ///< of the "liquid" speed of the report's Fig. 5

template <int Dim>
double largest_speed(const Flow<Dim>& flow, double least_fraction) {
  const Grid<Dim>& grid = flow.domain().grid;
  const double square = maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) {
    if (flow.total()[c] < least_fraction) return 0.0;
    double s = 0;
    for (int d = 0; d < Dim; ++d) s += flow.state().u[d][c] * flow.state().u[d][c];
    return s;
  });
  return std::sqrt(square);
}

/// Index of the axis column along d: the first cell at a symmetry side, else the middle one.
template <int Dim>
int axis_index(const Flow<Dim>& flow, int d) {
  const SideKind low = flow.domain().sides.at(d, 0).kind;
  const bool symmetric = low == SideKind::axis || low == SideKind::symmetry;
  return symmetric ? 0 : flow.domain().grid.owned_cells()[d] / 2;
}

/// Walks along d from cell `at` to where liquid, once met, ends: the interpolated crossing of the surface fraction. The
/// low end of the axis if no liquid is met.
template <int Dim>
double liquid_end(const Flow<Dim>& flow, Index<Dim> at, int d) {
  const Grid<Dim>& grid = flow.domain().grid;
  const int n = grid.owned_cells()[d];
  const auto fraction = [&](int i) {
    at[d] = i;
    return flow.total()[grid.cell(at)];
  };
  int i = at[d];
  while (i < n && fraction(i) < surface_fraction) ++i;
  if (i == n) return grid.face_position(d, 0);
  while (i + 1 < n && fraction(i + 1) >= surface_fraction) ++i;
  if (i + 1 == n) return grid.face_position(d, n);
  const double here = fraction(i);
  const double t = (here - surface_fraction) / (here - fraction(i + 1));
  return (1 - t) * grid.centre_position(d, i) + t * grid.centre_position(d, i + 1);
}

template <int Dim>
double potential_energy(const Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  // Slab by slab along each axis, whose position the flat index does not tell.
  double energy = 0;
  for (int d = 0; d < Dim; ++d) {
    const double g = flow.parameters().gravity[d];
    if (g == 0) continue;
    for (int i = 0; i < grid.owned_cells()[d]; ++i) {
      Box<Dim> slab = grid.cells();
      slab.lo[d] = i;
      slab.hi[d] = i + 1;
      const double mass = sum<Cell>(grid.layout(), slab,
                                    [&](Cell c, const Index<Dim>& at) { return flow.density()[c] * grid.volume(at); });
      energy -= mass * g * grid.centre_position(d, i);
    }
  }
  return energy;
}

template <int Dim>
double highest_liquid(const Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  constexpr int up = Dim - 1;
  for (int i = grid.owned_cells()[up] - 1; i >= 0; --i) {
    Box<Dim> slab = grid.cells();
    slab.lo[up] = i;
    slab.hi[up] = i + 1;
    if (maximum<Cell>(grid.layout(), slab, 0.0, [&](Cell c) { return flow.total()[c]; }) >= surface_fraction) {
      return grid.face_position(up, i + 1);
    }
  }
  return grid.face_position(up, 0);
}

}  // namespace

template <int Dim>
double species_volume(const Grid<Dim>& grid, const CellField& phi) {
  return sum<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) { return phi[c] * grid.volume(i); });
}

template <int Dim>
Diagnostics diagnose(const Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  const double circle = full_circle(grid);
  Diagnostics result;
  for (const CellField& phi : flow.state().phi) result.volume.push_back(circle * species_volume(grid, phi));
  result.kinetic_energy = circle * kinetic_energy(grid, flow.density(), flow.state().u);
  result.potential_energy = circle * potential_energy(flow);
  result.max_speed = largest_speed(flow, empty_fraction);
  result.max_speed_liquid = largest_speed(flow, liquid_fraction);

  constexpr int up = Dim - 1;
  Index<Dim> column;
  for (int d = 0; d < up; ++d) column[d] = axis_index(flow, d);
  result.height_axis = liquid_end(flow, column, up);
  result.height_max = highest_liquid(flow);
  Index<Dim> row = column;
  row[0] = 0;
  result.radius_base = liquid_end(flow, row, 0);
  return result;
}

#define QUICKSAND_INSTANTIATE(Dim)                                    \
  template double species_volume(const Grid<Dim>&, const CellField&); \
  template Diagnostics diagnose(const Flow<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
