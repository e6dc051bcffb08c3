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
#include "core/loop.hpp"
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
class Surface {
 public:
  explicit Surface(const Layout<Dim>& layout) : number_(layout, uncut) {}

  bool cuts(Cell c) const { return number_[c] != uncut; }
  /// The plane in a cell that is cut.
  const CellPlane<Dim>& plane(Cell c) const { return planes_[static_cast<std::size_t>(number_[c])]; }
  /// Puts plane(c) into the cells of the box where candidate(c), unless its normal is zero. No other cells are cut
  /// after that.
  template <class Candidate, class FindPlane>
  void find(const Layout<Dim>& layout, const Box<Dim>& box, Candidate&& candidate, FindPlane&& plane) {
    number_.fill(uncut);
    int count = 0;  // in order of the cells, whatever the number of threads: serial
    const Rows<Dim> rows(layout, box);
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      const std::ptrdiff_t start = rows.start(r);
      for (int i = 0; i < rows.length; ++i) {
        const Cell c{start + i};
        if (candidate(c)) number_[c] = count++;
      }
    }
    planes_.resize(static_cast<std::size_t>(count));
    for_each<Cell>(layout, box, [&](Cell c) {
      if (!cuts(c)) return;
      CellPlane<Dim>& found = planes_[static_cast<std::size_t>(number_[c])];
      found = plane(c);
      if (found.normal == Vec<Dim>{}) number_[c] = uncut;
    });
  }

 private:
  static constexpr int uncut = -1;
  Field<Cell, int> number_;
  std::vector<CellPlane<Dim>> planes_;
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
  const CellPlane<Dim>& plane = surface.plane(c);
  double offset = plane.offset;
  Vec<Dim> m;
  for (int e = 0; e < Dim; ++e) {
    const double n = plane.normal[e];
    if (e != d) offset += 0.5 * dt * n * u[e][c] / grid.width(e, c);
    // Mirrored axes make all components positive.
    if (n < 0) offset -= n;
    m[e] = std::abs(n);
  }
  const double thickness = std::min(std::abs(velocity) * dt / grid.width(d, c), 1.0);
  const bool slab_at_end = (side > 0) == (plane.normal[d] >= 0);
  if (slab_at_end) offset -= m[d] * (1 - thickness);
  m[d] *= thickness;
  return cut_fraction(m, offset);
}

}  // namespace quicksand
