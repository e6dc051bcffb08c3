#include "physics/bed_profile.hpp"

#include <algorithm>

#include "physics/diagnostics.hpp"

namespace quicksand {

namespace {

constexpr double bed_fraction = 0.5;

bool mirrors(const Side& side) { return side.kind == SideKind::axis || side.kind == SideKind::symmetry; }

/// The lowest cells of all columns.
template <int Dim>
Box<Dim> ground(const Grid<Dim>& grid) {
  Box<Dim> box = grid.cells();
  box.hi[Dim - 1] = 1;
  return box;
}

template <int Dim>
std::size_t column_number(const Grid<Dim>& grid, const Index<Dim>& i) {
  std::size_t n = 0;
  for (int d = Dim - 2; d >= 0; --d) {
    n = n * static_cast<std::size_t>(grid.owned_cells()[d]) + static_cast<std::size_t>(i[d]);
  }
  return n;
}

/// The bed's cells that hang together with the ground by their faces.
template <int Dim>
CellMask grounded(const Grid<Dim>& grid, const CellField& phi) {
  CellMask found(grid.layout(), 0);
  std::vector<Index<Dim>> open;
  const auto visit = [&](const Index<Dim>& i) {
    const Cell c = grid.cell(i);
    if (found[c] || !(phi[c] > bed_fraction)) return;
    found[c] = 1;
    open.push_back(i);
  };
  const Rows<Dim> rows(grid.layout(), ground(grid));
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    Index<Dim> i = grid.layout().multi(rows.start(r));
    for (int n = 0; n < rows.length; ++n, ++i[0]) visit(i);
  }
  while (!open.empty()) {
    const Index<Dim> at = open.back();
    open.pop_back();
    for (int d = 0; d < Dim; ++d) {
      for (const int step : {-1, 1}) {
        Index<Dim> next = at;
        next[d] += step;
        next = grid.layout().image(next);
        if (grid.cells().contains(next)) visit(next);
      }
    }
  }
  return found;
}

/// Height of the surface of a column whose cell `above` (a vertical index) is the first one beyond the bed.
/// \param fraction  of the column's cell with a vertical index
template <int Dim, class Fraction>
double surface_below(const Grid<Dim>& grid, int above, Fraction&& fraction) {
  constexpr int up = Dim - 1;
  const int last = std::max(above - 1, 0);
  double z = grid.face_position(up, last);
  for (int k = last; k <= above && k < grid.owned_cells()[up]; ++k) {
    z += std::clamp(fraction(k), 0.0, 1.0) * grid.width_1d(up, k);
  }
  return z;
}

}  // namespace

template <int Dim>
BedProfile<Dim> bed_profile(const Domain<Dim>& domain, const CellField& phi) {
  constexpr int up = Dim - 1;
  const Grid<Dim>& grid = domain.grid;
  const int n = grid.owned_cells()[up];
  BedProfile<Dim> profile;
  double images = full_circle(grid);
  std::size_t columns = 1;
  for (int d = 0; d < up; ++d) {
    ProfileAxis& axis = profile.axes[static_cast<std::size_t>(d)];
    for (int i = 0; i < grid.owned_cells()[d]; ++i) axis.centre.push_back(grid.centre_position(d, i));
    axis.low = grid.face_position(d, 0);
    axis.high = grid.face_position(d, grid.owned_cells()[d]);
    axis.mirrored_low = mirrors(domain.sides.at(d, 0));
    axis.mirrored_high = mirrors(domain.sides.at(d, 1));
    const bool plane = domain.sides.at(d, 0).kind == SideKind::symmetry || axis.mirrored_high;
    images *= plane ? 2 : 1;
    columns *= axis.centre.size();
  }
  profile.surface.resize(columns);
  profile.top.resize(columns);
  profile.area.resize(columns);

  profile.resolution = grid.width_1d(up, 0);
  for (int k = 1; k < n; ++k) profile.resolution = std::min(profile.resolution, grid.width_1d(up, k));

  const CellMask bed = grounded(grid, phi);
  for_each<Cell>(grid.layout(), ground(grid), [&](Cell c, const Index<Dim>& i) {
    const std::size_t column = column_number(grid, i);
    const auto cell = [&](int k) { return c + k * grid.step(up); };
    const auto fraction = [&](int k) { return phi[cell(k)]; };
    const auto is_bed = [&](int k) { return k < n && fraction(k) > bed_fraction; };
    int end = 0;
    while (is_bed(end) || (end > 0 && end < n && is_bed(end + 1))) ++end;
    int highest = n;
    while (highest > 0 && !bed[cell(highest - 1)]) --highest;
    profile.surface[column] = surface_below(grid, end, fraction);
    profile.top[column] = std::max(surface_below(grid, highest, fraction), profile.surface[column]);
    profile.area[column] = images * grid.area(up, i);
  });
  return profile;
}

template BedProfile<2> bed_profile(const Domain<2>&, const CellField&);
template BedProfile<3> bed_profile(const Domain<3>&, const CellField&);

}  // namespace quicksand
