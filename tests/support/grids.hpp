#pragma once
/// \file
/// Grids, domains and rough fields for tests.
#include <cmath>
#include <vector>

#include "core/domain.hpp"
#include "core/index.hpp"

namespace quicksand::testing {

/// Face coordinates of n equal cells on [lo, hi].
inline std::vector<double> uniform_axis(int n, double lo = 0, double hi = 1) {
  std::vector<double> faces;
  for (int i = 0; i <= n; ++i) faces.push_back(lo + (hi - lo) * i / n);
  return faces;
}

/// Face coordinates of n cells on [lo, hi] that grow geometrically; the last is `ratio` times as wide as the first.
inline std::vector<double> graded_axis(int n, double lo, double hi, double ratio) {
  std::vector<double> faces{0};
  for (int i = 0; i < n; ++i) faces.push_back(faces.back() + std::pow(ratio, n > 1 ? double(i) / (n - 1) : 0.0));
  const double length = faces.back();
  for (double& x : faces) x = lo + (hi - lo) * x / length;
  return faces;
}

/// The same kind on all sides, but a symmetry axis where the grid begins at r = 0.
template <int Dim>
Sides<Dim> all_sides(const Grid<Dim>& grid, SideKind kind) {
  Sides<Dim> sides;
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) sides.at(d, s).kind = kind;
  }
  if (grid.axisymmetric() && grid.global_faces(0).front() == 0) sides.at(0, 0).kind = SideKind::axis;
  return sides;
}

template <int Dim>
Domain<Dim> make_domain(Grid<Dim> grid, SideKind kind) {
  const Sides<Dim> sides = all_sides(grid, kind);
  return Domain<Dim>(std::move(grid), sides);
}

inline Grid<2> planar_grid(int n) { return {{uniform_axis(n), uniform_axis(n)}, Geometry::planar}; }
inline Grid<2> stretched_grid(int n) {
  return {{graded_axis(n, 0, 1, 4), graded_axis(n, 0, 1, 0.3)}, Geometry::planar};
}
inline Grid<2> tank_grid(int n) { return {{uniform_axis(n), uniform_axis(n)}, Geometry::axisymmetric}; }
inline Grid<3> box_grid(int n) { return {{uniform_axis(n), uniform_axis(n), uniform_axis(n)}, Geometry::cartesian}; }

/// A rough number in [-1, 1] that depends on the cell and on `seed` only, so that parts of a grid agree with the whole.
template <int Dim>
double rough(const Index<Dim>& i, double seed) {
  double phase = 1 + 7.31 * seed;
  for (int d = 0; d < Dim; ++d) phase += (12.9898 + 65.137 * d) * i[d];
  const double s = std::sin(phase) * 43758.5453;
  return 2 * (s - std::floor(s)) - 1;
}

/// Sets owned cells to f(centre).
template <int Dim, class F>
void set_cells(const Grid<Dim>& grid, CellField& field, F&& f) {
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) { field[c] = f(grid.centre(i)); });
}

/// Sets owned cells to rough numbers.
template <int Dim>
void set_rough(const Grid<Dim>& grid, CellField& field, double seed) {
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) { field[c] = rough(i, seed); });
}

template <int Dim>
CellVectors<Dim> rough_vectors(const Grid<Dim>& grid, double seed) {
  CellVectors<Dim> u(grid.layout());
  for (int d = 0; d < Dim; ++d) set_rough(grid, u[d], seed + d);
  return u;
}

/// Distance of a point from a centre.
template <int Dim>
double distance(const Vec<Dim>& a, const Vec<Dim>& b) {
  double square = 0;
  for (int d = 0; d < Dim; ++d) square += (a[d] - b[d]) * (a[d] - b[d]);
  return std::sqrt(square);
}

/// Largest |a - b| over the owned cells.
template <int Dim>
double largest_difference(const Grid<Dim>& grid, const CellField& a, const CellField& b) {
  return maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) { return std::abs(a[c] - b[c]); });
}

/// Integral over the owned cells.
template <int Dim>
double integral(const Grid<Dim>& grid, const CellField& f) {
  return sum<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) { return grid.volume(i) * f[c]; });
}

/// Volumes of the owned cells.
template <int Dim>
CellField volumes(const Grid<Dim>& grid) {
  CellField volume(grid.layout());
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) { volume[c] = grid.volume(i); });
  return volume;
}

}  // namespace quicksand::testing
