#include "core/grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/errors.hpp"

namespace quicksand {

namespace {

template <int Dim>
Index<Dim> count_cells(const std::array<std::vector<double>, Dim>& faces) {
  Index<Dim> n;
  for (int d = 0; d < Dim; ++d) n[d] = static_cast<int>(faces[static_cast<std::size_t>(d)].size()) - 1;
  return n;
}

void check_axis(const std::vector<double>& faces, int d) {
  const std::string name = "axis " + std::to_string(d);
  if (faces.size() < 2) throw InputError(name + " of the grid needs at least one cell");
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    if (!(faces[i + 1] > faces[i])) throw InputError(name + " of the grid: face coordinates must increase");
  }
}

/// Shape function integrals over [a, b] with the weight w(x) = w0 + w1 x; |w| keeps ghost cells at r < 0 positive.
LineElement integrate(double a, double b, double w0, double w1) {
  const double h = b - a;
  const double wa = std::abs(w0 + w1 * a);
  const double wb = std::abs(w0 + w1 * b);
  LineElement e{};
  e.stiffness = (wa + wb) / (2 * h);
  e.mass[0][0] = h * (3 * wa + wb) / 12;
  e.mass[1][1] = h * (wa + 3 * wb) / 12;
  e.mass[0][1] = e.mass[1][0] = h * (wa + wb) / 12;
  e.fraction[0] = (2 * wa + wb) / (3 * (wa + wb));
  e.fraction[1] = (wa + 2 * wb) / (3 * (wa + wb));
  return e;
}

}  // namespace

template <int Dim>
Grid<Dim>::Grid(std::array<std::vector<double>, Dim> faces, Geometry geometry, const Box<Dim>& owned,
                const AxisFlags<Dim>& periodic)
    : global_faces_(std::move(faces)), geometry_(geometry), periodic_(periodic), owned_global_(owned) {
  for (int d = 0; d < Dim; ++d) check_axis(global_faces_[at(d)], d);
  global_cells_ = count_cells<Dim>(global_faces_);
  if (axisymmetric() && global_faces_[0].front() < 0) {
    throw InputError("an axisymmetric grid can't begin at a negative radius");
  }
  if (axisymmetric() && periodic_[0]) throw InputError("the radius of an axisymmetric grid can't be periodic");
  Index<Dim> n;
  AxisFlags<Dim> closed;
  for (int d = 0; d < Dim; ++d) {
    n[d] = owned.extent(d);
    closed[d] = periodic_[d] && n[d] == global_cells_[d];
  }
  layout_ = Layout<Dim>(n, closed);
  for (int d = 0; d < Dim; ++d) store_axis(d);
}

template <int Dim>
Grid<Dim>::Grid(std::array<std::vector<double>, Dim> faces, Geometry geometry)
    : Grid(faces, geometry, Box<Dim>{Index<Dim>{}, count_cells<Dim>(faces)}) {}

template <int Dim>
Grid<Dim> Grid<Dim>::with_periodic(const AxisFlags<Dim>& periodic) const {
  return Grid(global_faces_, geometry_, owned_global_, periodic);
}

template <int Dim>
void Grid<Dim>::store_axis(int d) {
  const std::vector<double>& global = global_faces_[at(d)];
  const int n_global = global_cells_[d];
  const double length = global.back() - global.front();
  // Global face coordinate, repeated or mirrored about the domain's ends.
  const auto position = [&](int i) {
    if (periodic_[d]) {
      const int inside = (i % n_global + n_global) % n_global;
      const int periods = (i - inside) / n_global;
      return global[at(inside)] + periods * length;
    }
    // An axis of one cell has no second width to mirror and repeats its only one.
    if (i < -n_global) return global.front() - length * -i / n_global;
    if (i > 2 * n_global) return global.back() + length * (i - n_global) / n_global;
    if (i < 0) return 2 * global.front() - global[at(-i)];
    if (i > n_global) return 2 * global.back() - global[at(2 * n_global - i)];
    return global[at(i)];
  };
  const int n = layout_.cells()[d] + 2 * ghosts;
  const bool radial = axisymmetric() && d == 0;
  Axis& axis = axes_[at(d)];
  for (int i = 0; i <= n; ++i) axis.face.push_back(position(owned_global_.lo[d] + i - ghosts));
  for (int i = 0; i < n; ++i) {
    const double a = axis.face[at(i)];
    const double b = axis.face[at(i + 1)];
    axis.centre.push_back((a + b) / 2);
    axis.width.push_back(b - a);
    axis.element.push_back(integrate(a, b, radial ? 0.0 : 1.0, radial ? 1.0 : 0.0));
  }
  // Copies must not differ by round-off: what leaves at one end of the axis enters at the other.
  for (int i = 0; i < n; ++i) axis.width[at(i)] = axis.width[at(layout_.image(d, i - ghosts) + ghosts)];
  axis.spacing_around.resize(axis.width.size());
  for (int i = 1; i + 1 < n; ++i) {
    axis.spacing_around[at(i)] = axis.width[at(i)] + 0.5 * (axis.width[at(i - 1)] + axis.width[at(i + 1)]);
  }
  // |r|: ghost cells beyond the axis mirror those inside.
  for (int i = 0; i < n; ++i) axis.measure.push_back((radial ? std::abs(axis.centre[at(i)]) : 1.0) * axis.width[at(i)]);
  for (int i = 0; i <= n; ++i) axis.face_weight.push_back(radial ? std::abs(axis.face[at(i)]) : 1.0);
  double narrowest = length;
  for (int i = 0; i < n_global; ++i) narrowest = std::min(narrowest, global[at(i + 1)] - global[at(i)]);
  smallest_width_ = d == 0 ? narrowest : std::min(smallest_width_, narrowest);
}

template <int Dim>
Box<Dim> Grid<Dim>::nodes() const {
  Box<Dim> box = cells();
  for (int d = 0; d < Dim; ++d) {
    if (!layout_.periodic(d)) ++box.hi[d];
  }
  return box;
}

template <int Dim>
Vec<Dim> Grid<Dim>::centre(const Index<Dim>& i) const {
  Vec<Dim> x;
  for (int d = 0; d < Dim; ++d) x[d] = centre_position(d, i[d]);
  return x;
}

template class Grid<2>;
template class Grid<3>;

}  // namespace quicksand
