#pragma once
/// \file
/// The liquid's surface as a plane in every cell it cuts (piecewise linear interface), for sharp transport of the
/// fractions.
///
/// Deviates from the report, whose limited slopes smear the surface of a falling body over six cells within a second;
/// see docs/numerics.md for what that does to the slug. Planes may overfill or overdraw a cell where they turn within a
/// step: the redistribution and the outflow limit take care of both, so no direction splitting is needed.
#include <vector>

#include "core/domain.hpp"
#include "physics/plane.hpp"

namespace quicksand {

/// Planes n . x = offset in cell coordinates 0 <= x <= 1, liquid where n . x <= offset; sum |n_d| = 1.
template <int Dim>
struct Surface {
  CellVectors<Dim> normal;  ///< out of the liquid; zero where a cell is not cut
  CellField offset;

  explicit Surface(const Layout<Dim>& layout) : normal(layout), offset(layout) {}

  bool cuts(Cell c) const {
    bool cut = false;
    for (int d = 0; d < Dim; ++d) cut = cut || normal[d][c] != 0;
    return cut;
  }
};

/// The surfaces of the species' nested regions: region i holds species 0 ... i together, the last one all liquid.
template <int Dim>
struct Interfaces {
  std::vector<CellField> region;      ///< fraction of the region
  std::vector<Surface<Dim>> surface;  ///< its planes

  Interfaces(const Layout<Dim>& layout, std::size_t n_species)
      : region(n_species, CellField(layout)), surface(n_species, Surface<Dim>(layout)) {}
};

/// Finds regions and planes from the species' fractions (both ghost layers filled).
template <int Dim>
void reconstruct_interfaces(const Grid<Dim>& grid, const std::vector<CellField>& phi, Interfaces<Dim>& interfaces);

/// Finds the planes in owned cells and one ghost layer from the total fraction (both ghost layers filled).
template <int Dim>
void reconstruct_surface(const Grid<Dim>& grid, const CellField& total, Surface<Dim>& surface);

/// Filled part of what crosses a face of cell c during dt: the slab of thickness |velocity| dt inside the face, with
/// the plane moved by the transverse velocities to half time. \param side  +1: high face along d, -1: low face
template <int Dim>
double swept_fraction(const Grid<Dim>& grid, const Surface<Dim>& surface, const CellField& total,
                      const CellVectors<Dim>& u, Cell c, int d, int side, double velocity, double dt) {
  if (!surface.cuts(c)) return std::min(total[c], 1.0);
  double offset = surface.offset[c];
  Vec<Dim> m;
  for (int e = 0; e < Dim; ++e) {
    const double n = surface.normal[e][c];
    if (e != d) offset += 0.5 * dt * n * u[e][c] / grid.width(e, c);
    // Mirrored axes make all components positive.
    if (n < 0) offset -= n;
    m[e] = std::abs(n);
  }
  const double thickness = std::min(std::abs(velocity) * dt / grid.width(d, c), 1.0);
  const bool slab_at_end = (side > 0) == (surface.normal[d][c] >= 0);
  if (slab_at_end) offset -= m[d] * (1 - thickness);
  m[d] *= thickness;
  return cut_fraction(m, offset);
}

}  // namespace quicksand
