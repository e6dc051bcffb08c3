#include "core/domain.hpp"

namespace quicksand {

template <int Dim>
Domain<Dim>::Domain(const Grid<Dim>& g, const Sides<Dim>& s)
    : grid(g.with_periodic(periodic_axes(s))), sides(s), aperture(grid.layout()) {
  for (int d = 0; d < Dim; ++d) {
    for_each<Face>(layout(), grow(grid.faces(d), 1), [&](Face f) { aperture[d][f] = grid.area(d, f); });
    for (int side = 0; side < 2; ++side) {
      if (is_open(sides.at(d, side))) continue;
      for_each<Face>(layout(), side_faces(d, side), [&](Face f) { aperture[d][f] = 0; });
    }
  }
}

template <int Dim>
Box<Dim> Domain<Dim>::side_faces(int d, int s) const {
  Box<Dim> layer = grow(grid.cells(), 1);
  layer.lo[d] = s == 0 ? 0 : grid.owned_cells()[d];
  layer.hi[d] = layer.lo[d] + (grid.at_boundary(d, s) ? 1 : 0);
  return layer;
}

template struct Domain<2>;
template struct Domain<3>;

}  // namespace quicksand
