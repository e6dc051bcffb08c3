#include "physics/surface.hpp"

#include <cmath>

namespace quicksand {

namespace {

/// Fractions closer than this to 0 or 1 count as uncut. No more than round-off: a film taken for uncut would be spread
/// over its cell, that is lifted by half a cell, and surfaces at rest would gain energy from the films that round-off
/// puts on them.
constexpr double uncut = 1e-14;

/// Normals shorter than this part of that of a full cell beside an empty one belong to no surface: drops and wisps with
/// next to nothing around them, and mixtures that vary smoothly. Their planes would lie anywhere, and hold a speck on
/// the side of its cell that it flies away from, so that it never leaves. Uncut, they move with their cell's velocity.
constexpr double faint = 0.05;

/// Outward normal times cell width along each axis, from differences of the fraction averaged over the 3^Dim block with
/// weights 1-2-1 across (Youngs 1984).
template <int Dim>
Vec<Dim> youngs_normal(const Grid<Dim>& grid, const CellField& total, Cell c, const Index<Dim>& i) {
  Vec<Dim> n;
  for (int d = 0; d < Dim; ++d) {
    const Step along = grid.step(d);
    double difference = 0;
    constexpr int across_count = Dim == 2 ? 3 : 9;
    for (int k = 0; k < across_count; ++k) {
      Cell at = c;
      double weight = 1;
      int rest = k;
      for (int e = 0; e < Dim; ++e) {
        if (e == d) continue;
        const int shift = rest % 3 - 1;
        rest /= 3;
        at = at + shift * grid.step(e);
        weight *= shift == 0 ? 2 : 1;
      }
      difference += weight * (total[at - along] - total[at + along]);
    }
    n[d] = difference * grid.width_1d(d, i[d]) / grid.spacing_around(d, i[d]);
  }
  return n;
}

}  // namespace

template <int Dim>
void reconstruct_surface(const Grid<Dim>& grid, const CellField& total, Surface<Dim>& surface) {
  const auto candidate = [&](Cell c, const Index<Dim>&) { return !(total[c] < uncut || total[c] > 1 - uncut); };
  surface.find(grid.layout(), grow(grid.cells(), 1), candidate,
               [&](Cell c, const Index<Dim>& i, CellPlane<Dim>& plane) {
                 const Vec<Dim> n = youngs_normal(grid, total, c, i);
                 double norm = 0;
                 for (int d = 0; d < Dim; ++d) norm += std::abs(n[d]);
                 constexpr double full_norm = Dim == 2 ? 2 : 8;
                 if (norm < faint * full_norm) return false;
                 Vec<Dim> m;
                 double mirrored = 0;
                 for (int d = 0; d < Dim; ++d) {
                   plane.normal[d] = n[d] / norm;
                   m[d] = std::abs(n[d]) / norm;
                   if (n[d] < 0) mirrored += m[d];
                 }
                 plane.offset = plane_offset(m, total[c]) - mirrored;
                 return true;
               });
}

template <int Dim>
void reconstruct_interfaces(const Grid<Dim>& grid, const Fractions& phi, Interfaces<Dim>& interfaces) {
  interfaces.resize(phi.size(), Surface<Dim>(grid.layout()));
  reconstruct_surface(grid, phi[0], interfaces[0]);
  if (phi.size() == 1) return;
  CellField region = phi[0];
  for (std::size_t k = 1; k < phi.size(); ++k) {
    for_each<Cell>(grid.layout(), grow(grid.cells(), ghosts), [&](Cell c) { region[c] += phi[k][c]; });
    reconstruct_surface(grid, region, interfaces[k]);
  }
}

template void reconstruct_interfaces(const Grid<2>&, const Fractions&, Interfaces<2>&);
template void reconstruct_interfaces(const Grid<3>&, const Fractions&, Interfaces<3>&);
template void reconstruct_surface(const Grid<2>&, const CellField&, Surface<2>&);
template void reconstruct_surface(const Grid<3>&, const CellField&, Surface<3>&);

}  // namespace quicksand
