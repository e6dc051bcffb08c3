#pragma once
/// \file
/// The grids that a run moves through.
#include <optional>

#include "app/case_config.hpp"
#include "physics/flow.hpp"

namespace quicksand {

/// A box of space.
template <int Dim>
struct Region {
  Vec<Dim> low, high;
};

/// About how many cells the first grid of a case has that `regrid` refines around its bubbles; 0 without such.
double first_grid_cells(const CaseConfig& config);

/// The grids of a case in turn: those of its stages, then its own. With `regrid` they are refined around the
/// bubbles of the start until these have grown large enough for one of them (and not again when they collapse): a block
/// of fine cells reaches some radii beyond them, and when they have grown close to its edge a new block with wider
/// cells takes its place, up to the grid as it was given.
template <int Dim>
class GridSequence {
 public:
  explicit GridSequence(const CaseConfig& config);

  /// The grid of the start, with its sides.
  Domain<Dim> first();
  /// The domain to go on with, if it is another than the flow's.
  std::optional<Domain<Dim>> next(const Flow<Dim>& flow);
  /// Which grid the run is on, from 1.
  int number() const { return number_; }
  /// Hands over where in the sequence the run is.
  void exchange(Archive& archive);

 private:
  /// The present stage's grid as the case gives it.
  GridConfig base() const;
  /// The present stage's grid, refined around the bubbles if need be; ends `following_` if not.
  Domain<Dim> make(const std::vector<Region<Dim>>& bubbles);
  /// Whether a bubble has come close to the edge of the block.
  bool outgrown(const std::vector<Region<Dim>>& bubbles) const;
  /// Radius of a bubble; one that a plane of symmetry cuts is counted whole.
  double radius(const Region<Dim>& bubble) const;

  const CaseConfig& config_;
  Sides<Dim> sides_;
  std::size_t stage_ = 0;
  int number_ = 0;
  bool following_;
  Region<Dim> block_;
  double block_radius_ = 0;  ///< of the bubbles that the block was made for
};

extern template class GridSequence<2>;
extern template class GridSequence<3>;

}  // namespace quicksand
