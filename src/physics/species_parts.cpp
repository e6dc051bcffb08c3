#include "physics/species_parts.hpp"

#include <algorithm>
#include <cmath>

namespace quicksand {

namespace {

/// A region may stick out of one that contains it by this part of a cell: the round-off of its plane.
constexpr double crossing = 1e-12;

}  // namespace

template <int Dim>
SpeciesParts<Dim>::SpeciesParts(const GridOverlap<Dim>& overlap, const Fractions& phi,
                                const Interfaces<Dim>& interfaces)
    : overlap_(overlap), phi_(phi), interfaces_(interfaces), mixed_(overlap.source().layout()) {
  for (std::size_t k = 0; k < phi.size(); ++k) {
    offset_.emplace_back(overlap.source().layout());
    place_planes(k);
  }
  find_mixed();
}

template <int Dim>
double SpeciesParts<Dim>::filled(std::size_t k, const GridPart<Dim>& part, double offset) const {
  const Surface<Dim>& surface = interfaces_[k];
  const Cell c = part.source;
  if (!surface.has(c)) return region_fraction(phi_, k, c);
  // The part as a unit cube of its own, mirrored along axes where the normal is negative.
  Vec<Dim> m;
  for (int d = 0; d < Dim; ++d) {
    const double n = surface[c].normal[d];
    m[d] = std::abs(n) * (part.high[d] - part.low[d]);
    offset -= n * (n >= 0 ? part.low[d] : part.high[d]);
  }
  return cut_fraction(m, offset);
}

template <int Dim>
void SpeciesParts<Dim>::place_planes(std::size_t k) {
  const Grid<Dim>& grid = overlap_.source();
  const Surface<Dim>& surface = interfaces_[k];
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    if (!surface.has(c)) return;
    const CellPlane<Dim>& plane = surface[c];
    double low = 0;
    double high = 0;
    for (const double n : plane.normal.v) (n < 0 ? low : high) += n;
    const double fraction = region_fraction(phi_, k, c);
    const auto error = [&](double offset) {
      double volume = 0;
      overlap_.for_parts_of_source(i,
                                   [&](const GridPart<Dim>& part) { volume += part.volume * filled(k, part, offset); });
      return volume / grid.volume(i) - fraction;
    };
    offset_[k][c] = rising_root(error, low, high, -fraction, 1 - fraction, plane.offset);
  });
}

template <int Dim>
void SpeciesParts<Dim>::find_mixed() {
  const Grid<Dim>& grid = overlap_.source();
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    overlap_.for_parts_of_source(i, [&](const GridPart<Dim>& part) {
      const double share = part.volume / grid.volume(i);
      for (std::size_t k = 1; k < species(); ++k) {
        const double excess = share * (filled(k - 1, part) - filled(k, part));
        // Fractions may be below zero by round-off: that is no crossing.
        if (excess > crossing + std::max(-phi_[k][c], 0.0)) mixed_[c] = 1;
      }
    });
  });
}

template class SpeciesParts<2>;
template class SpeciesParts<3>;

}  // namespace quicksand
