#include "physics/dual_element.hpp"

namespace quicksand {

template <int Dim>
DualMesh<Dim>::DualMesh(const Domain<Dim>& domain)
    : cells_(domain.grid.owned_cells()), axisymmetric_(domain.grid.axisymmetric()) {
  const Grid<Dim>& grid = domain.grid;
  for (int d = 0; d < Dim; ++d) {
    step_[d] = grid.step(d);
    const int n = cells_[d];
    Axis& axis = axes_[static_cast<std::size_t>(d)];
    periodic_[d] = grid.layout().periodic(d);
    axis.position.push_back(periodic_[d] ? grid.centre_position(d, -1) : grid.face_position(d, 0));
    for (int i = 0; i < n; ++i) axis.position.push_back(grid.centre_position(d, i));
    axis.position.push_back(periodic_[d] ? grid.centre_position(d, n) : grid.face_position(d, n));
    for (std::size_t i = 0; i + 1 < axis.position.size(); ++i) {
      axis.width.push_back(axis.position[i + 1] - axis.position[i]);
    }
    for (int s = 0; s < 2; ++s) {
      for (int c = 0; c < Dim; ++c) {
        // The boundary point lies half way between a cell and its ghost.
        wall_factor_[d][s][c] = 0.5 * (1 + viscous_velocity_rule(domain.sides.at(d, s), c == d).alpha);
      }
    }
  }
}

template class DualMesh<2>;
template class DualMesh<3>;

}  // namespace quicksand
