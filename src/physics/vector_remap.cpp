#include "physics/vector_remap.hpp"

#include <algorithm>
#include <cmath>

#include "core/periodic.hpp"
#include "core/slope.hpp"
#include "physics/energy.hpp"

namespace quicksand {

namespace {

template <int Dim>
double norm_square(const Vec<Dim>& v) {
  double square = 0;
  for (int d = 0; d < Dim; ++d) square += v[d] * v[d];
  return square;
}

/// The largest factor up to 1 for which |u + factor v|^2 <= limit, where |u|^2 <= limit.
template <int Dim>
double largest_factor(const Vec<Dim>& u, const Vec<Dim>& v, double limit) {
  const double a = norm_square(v);
  double b = 0;
  for (int d = 0; d < Dim; ++d) b += u[d] * v[d];
  const double c = std::min(norm_square(u) - limit, 0.0);
  if (a + 2 * b + c <= 0) return 1;
  return std::clamp((std::sqrt(b * b - a * c) - b) / a, 0.0, 1.0);
}

/// After so many exchanges the rest is taken from all deviations from the mean velocity alike.
constexpr int most_exchanges = 200;
constexpr double energy_slack = 1e-14;

/// u = u_m + s (u - u_m), u_m the mean velocity by mass, with the s that gives the energy `limit`.
template <int Dim>
void shrink_to_mean(const Grid<Dim>& grid, const CellField& rho, double limit, CellVectors<Dim>& u) {
  const auto over_mass = [&](auto&& f) {
    return sum<Cell>(grid.layout(), grid.cells(),
                     [&](Cell c, const Index<Dim>& i) { return rho[c] * grid.volume(i) * f(c); });
  };
  const double mass = over_mass([](Cell) { return 1.0; });
  Vec<Dim> mean;
  for (int d = 0; d < Dim; ++d) mean[d] = over_mass([&](Cell c) { return u[d][c]; }) / mass;
  const double least = 0.5 * mass * norm_square(mean);
  const double above = kinetic_energy(grid, rho, u) - least;
  const double s = above > 0 ? std::sqrt(std::clamp((limit - least) / above, 0.0, 1.0)) : 1.0;
  for (int d = 0; d < Dim; ++d) {
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c) {
      if (rho[c] > 0) u[d][c] = mean[d] + s * (u[d][c] - mean[d]);
    });
  }
}

}  // namespace

template <int Dim>
MassMap<Dim>::MassMap(const SpeciesParts<Dim>& parts, const GridOverlap<Dim>& overlap,
                      const std::vector<Species>& species, const CellField& total, const CellField& rho)
    : parts_(parts),
      overlap_(overlap),
      species_(species),
      total_(total),
      rho_(rho),
      centre_(overlap.source().layout()) {
  const Grid<Dim>& grid = overlap.source();
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    double whole = 0;
    Vec<Dim> moment;
    overlap.for_parts_of_source(i, [&](const GridPart<Dim>& part) {
      const double m = mass(part);
      whole += m;
      for (int d = 0; d < Dim; ++d) moment[d] += m * part.centre[d];
    });
    for (int d = 0; d < Dim; ++d) centre_[d][c] = whole > 0 ? moment[d] / whole : 0.0;
  });
}

template <int Dim>
double MassMap<Dim>::mass(const GridPart<Dim>& part) const {
  double m = 0;
  parts_.for_volumes(part, [&](std::size_t k, double volume) { m += species_[k].density * volume; });
  return std::max(m, 0.0);
}

/// S (x - x_m) at the centre of a part.
template <int Dim>
Vec<Dim> MassMap<Dim>::deviation(const CellVectors<Dim>& q, const GridPart<Dim>& part) const {
  const Grid<Dim>& grid = overlap_.source();
  const Cell c = part.source;
  const Index<Dim> i = grid.layout().multi(c.n);
  Vec<Dim> v;
  for (int d = 0; d < Dim; ++d) {
    const Step e = grid.step(d);
    if (std::min({total_[c - e], total_[c], total_[c + e]}) < empty_fraction) continue;
    const double distance = part.centre[d] - centre_[d][c];
    for (int k = 0; k < Dim; ++k) v[k] += limited_slope(grid, q[k], c, i, d) * distance;
  }
  return v;
}

template <int Dim>
void MassMap<Dim>::map(const CellVectors<Dim>& q, CellVectors<Dim>& mapped) const {
  const Grid<Dim>& from = overlap_.source();
  const Grid<Dim>& to = overlap_.target();
  CellField factor(from.layout());
  for_each<Cell>(from.layout(), from.cells(), [&](Cell c, const Index<Dim>& i) {
    double limit = norm_square(q.at(c));
    for (int d = 0; d < Dim; ++d) {
      for (const int side : {0, 1}) {
        // Beyond the domain there may be what comes in, faster than anything inside.
        if (from.at_boundary(d, side) && i[d] == (side == 0 ? 0 : from.owned_cells()[d] - 1)) continue;
        const Cell n = side == 0 ? c - from.step(d) : c + from.step(d);
        if (rho_[n] > 0) limit = std::max(limit, norm_square(q.at(n)));
      }
    }
    double largest = 1;
    overlap_.for_parts_of_source(i, [&](const GridPart<Dim>& part) {
      largest = std::min(largest, largest_factor(q.at(c), deviation(q, part), limit));
    });
    factor[c] = largest;
  });
  for_each<Cell>(to.layout(), to.cells(), [&](Cell c, const Index<Dim>& i) {
    double whole = 0;
    Vec<Dim> momentum;
    overlap_.for_parts_of_target(i, [&](const GridPart<Dim>& part) {
      const double m = mass(part);
      const Vec<Dim> v = deviation(q, part);
      whole += m;
      for (int d = 0; d < Dim; ++d) momentum[d] += m * (q[d][part.source] + factor[part.source] * v[d]);
    });
    for (int d = 0; d < Dim; ++d) mapped[d][c] = whole > 0 ? momentum[d] / whole : 0.0;
  });
}

template <int Dim>
void lower_kinetic_energy(const Domain<Dim>& domain, const CellField& rho, double limit, CellVectors<Dim>& u) {
  const Grid<Dim>& grid = domain.grid;
  CellVectors<Dim> smoother(grid.layout());
  const auto too_much = [&] { return kinetic_energy(grid, rho, u) > limit * (1 + energy_slack); };
  for (int exchange = 0; exchange < most_exchanges && too_much(); ++exchange) {
    for (int d = 0; d < Dim; ++d) wrap(grid.layout(), grid.cells(), u[d]);
    for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
      const double mass = rho[c] * grid.volume(i);
      for (int d = 0; d < Dim; ++d) smoother[d][c] = u[d][c];
      if (!(mass > 0)) return;
      for (int d = 0; d < Dim; ++d) {
        const Step e = grid.step(d);
        for (const int side : {-1, 1}) {
          const Cell n = c + side * e;
          const bool open = domain.passes(d, side < 0 ? i : shifted(i, d, 1));
          if (!open || domain.beyond[n] != Beyond::nothing) continue;
          // A quarter of the smaller mass over all axes: at most half a cell's momentum changes hands.
          const double exchanged = std::min(mass, rho[n] * grid.volume(shifted(i, d, side))) / (4 * Dim);
          for (int k = 0; k < Dim; ++k) smoother[k][c] += exchanged / mass * (u[k][n] - u[k][c]);
        }
      }
    });
    for (int d = 0; d < Dim; ++d) {
      for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c) { u[d][c] = smoother[d][c]; });
    }
  }
  if (too_much()) shrink_to_mean(grid, rho, limit, u);
}

template class MassMap<2>;
template class MassMap<3>;
template void lower_kinetic_energy(const Domain<2>&, const CellField&, double, CellVectors<2>&);
template void lower_kinetic_energy(const Domain<3>&, const CellField&, double, CellVectors<3>&);

}  // namespace quicksand
