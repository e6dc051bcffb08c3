#pragma once
/// \file
/// What the parts of cut cells hold: the species' volumes behind their planes.
#include "core/grid_overlap.hpp"
#include "physics/mixture.hpp"
#include "physics/surface.hpp"

namespace quicksand {

/// The species' volumes in the parts into which the cells of a grid are cut by another. The volumes in all parts of a
/// cell add up to what the cell holds, and no part holds more than fits.
///
/// Planes are those of the nested regions (Interfaces), moved so that the parts of a region add up to its volume where
/// cells are not boxes (axisymmetric grids). Where the planes of two regions cross in a cell its liquid is taken for
/// mixed.
template <int Dim>
class SpeciesParts {
 public:
  /// All arguments must outlive this.
  SpeciesParts(const GridOverlap<Dim>& overlap, const Fractions& phi, const Interfaces<Dim>& interfaces);

  std::size_t species() const { return phi_.size(); }
  /// Calls body(species, volume) for what a part holds of each species.
  template <class Body>
  void for_volumes(const GridPart<Dim>& part, Body&& body) const {
    const Cell c = part.source;
    const std::size_t whole = species() - 1;
    const double mixed_share = mixed_[c] ? part.volume * filled(whole, part) / region_fraction(phi_, whole, c) : 0.0;
    double below = 0;
    for (std::size_t k = 0; k < species(); ++k) {
      const double up_to = mixed_[c] ? below + mixed_share * phi_[k][c] : part.volume * filled(k, part);
      body(k, up_to - below);
      below = up_to;
    }
  }

 private:
  /// Filled fraction of a part by region k, with its plane at a given offset.
  double filled(std::size_t k, const GridPart<Dim>& part, double offset) const;
  double filled(std::size_t k, const GridPart<Dim>& part) const { return filled(k, part, offset_[k][part.source]); }
  void place_planes(std::size_t k);
  void find_mixed();

  const GridOverlap<Dim>& overlap_;
  const Fractions& phi_;
  const Interfaces<Dim>& interfaces_;
  std::vector<CellField> offset_;  ///< per region, of the cells that it cuts
  CellMask mixed_;
};

extern template class SpeciesParts<2>;
extern template class SpeciesParts<3>;

}  // namespace quicksand
