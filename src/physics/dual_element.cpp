#include "physics/dual_element.hpp"

namespace quicksand {

template <int Dim>
DualMesh<Dim>::DualMesh(const Domain<Dim>& domain)
    : cells_(domain.grid.owned_cells()),
      axisymmetric_(domain.grid.axisymmetric()),
      side_velocities_(domain.side_velocities),
      sides_move_(side_velocities_.any()) {
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

template <int Dim>
void DualMesh<Dim>::set_wall_velocities(const Index<Dim>& i, DualElement<Dim>& e) const {
  for (int k = 0; k < corner_count<Dim>; ++k) {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) {
      x[d] = axes_[static_cast<std::size_t>(d)].position[static_cast<std::size_t>(i[d] + ((k >> d) & 1))];
    }
    double free[Dim];  // component by component: product of the factors of the sides met so far
    for (int c = 0; c < Dim; ++c) {
      e.wall[k][c] = 0;
      free[c] = 1;
    }
    for (int d = 0; d < Dim; ++d) {
      const int s = (k >> d) & 1;
      if (i[d] != (s == 0 ? 0 : cells_[d])) continue;
      const Vec<Dim> given = side_velocities_.at(d, s, x);
      for (int c = 0; c < Dim; ++c) {
        const double factor = wall_factor_[d][s][c];
        e.wall[k][c] = factor * e.wall[k][c] + (1 - factor) * free[c] * given[c];
        free[c] *= factor;
      }
    }
    for (int c = 0; c < Dim; ++c) e.moved = e.moved || e.wall[k][c] != 0;
  }
}

template class DualMesh<2>;
template class DualMesh<3>;

}  // namespace quicksand
