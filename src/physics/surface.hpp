#pragma once
/// \file
/// The liquid's surface as a plane in every cell it cuts (piecewise linear interface), for sharp transport of the
/// fractions.
///
/// Deviates from the report, whose limited slopes smear the surface of a falling body over six cells within a second;
/// see docs/numerics.md for what that does to the slug. Planes may overfill or overdraw a cell where they turn within a
/// step: the redistribution and the outflow limit take care of both, so no direction splitting is needed.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/domain.hpp"
#include "core/sparse_field.hpp"
#include "physics/mixture.hpp"
#include "physics/plane.hpp"

namespace quicksand {

/// n . x = offset in cell coordinates 0 <= x <= 1, liquid where n . x <= offset; sum |n_d| = 1.
template <int Dim>
struct CellPlane {
  Vec<Dim> normal;  ///< out of the liquid; zero where there is no plane
  double offset = 0;
};

/// The planes of the few cells that a surface cuts.
template <int Dim>
using Surface = SparseField<Cell, CellPlane<Dim>>;

/// The surfaces of the species' nested regions: region k holds species 0 ... k together, the last one all liquid.
template <int Dim>
using Interfaces = std::vector<Surface<Dim>>;

/// Fraction of region k in a cell.
inline double region_fraction(const Fractions& phi, std::size_t k, Cell c) {
  double fraction = phi[0][c];
  for (std::size_t j = 1; j <= k; ++j) fraction += phi[j][c];
  return fraction;
}

/// Finds the regions' planes from the species' fractions (both ghost layers filled). \param interfaces  of any size
template <int Dim>
void reconstruct_interfaces(const Grid<Dim>& grid, const Fractions& phi, Interfaces<Dim>& interfaces);

/// Finds the planes in owned cells and one ghost layer from the total fraction (both ghost layers filled).
template <int Dim>
void reconstruct_surface(const Grid<Dim>& grid, const CellField& total, Surface<Dim>& surface);

/// Filled part of what crosses a face of cell c with index i during dt: the slab of thickness |velocity| dt inside the
/// face, with the plane moved by the transverse velocities to half time. \param filling  fraction of the region in the
/// cell \param side     +1: high face along d, -1: low face
template <int Dim>
double swept_fraction(const Grid<Dim>& grid, const Surface<Dim>& surface, double filling, const CellVectors<Dim>& u,
                      Cell c, const Index<Dim>& i, int d, int side, double velocity, double dt) {
  if (!surface.has(c)) return std::min(filling, 1.0);
  const CellPlane<Dim>& plane = surface[c];
  double offset = plane.offset;
  Vec<Dim> m;
  for (int e = 0; e < Dim; ++e) {
    const double n = plane.normal[e];
    if (e != d) offset += 0.5 * dt * n * u[e][c] / grid.width_1d(e, i[e]);
    // Mirrored axes make all components positive.
    if (n < 0) offset -= n;
    m[e] = std::abs(n);
  }
  const double thickness = std::min(std::abs(velocity) * dt / grid.width_1d(d, i[d]), 1.0);
  const bool slab_at_end = (side > 0) == (plane.normal[d] >= 0);
  if (slab_at_end) offset -= m[d] * (1 - thickness);
  m[d] *= thickness;
  return cut_fraction(m, offset);
}

}  // namespace quicksand
