#pragma once
/// \file
/// How multi-indices map to flat indices: x fastest, `ghosts` layers around the owned cells. And which axes close to a
/// ring: there position n is position 0 again, for cells, faces and nodes alike, and ghost positions hold copies.
#include "core/index.hpp"

namespace quicksand {

/// Number of ghost layers around the owned cells: a limited slope in the first ghost cell needs the second.
inline constexpr int ghosts = 2;

/// Strides and origin of the ghosted index space that all fields of one grid share.
template <int Dim>
class Layout {
 public:
  Layout() = default;
  /// \param cells     owned cells along each axis
  /// \param periodic  axes whose last cell is next to their first
  explicit Layout(const Index<Dim>& cells, const AxisFlags<Dim>& periodic = {}) : cells_(cells), periodic_(periodic) {
    std::ptrdiff_t stride = 1;
    for (int d = 0; d < Dim; ++d) {
      strides_[d] = stride;
      origin_ += ghosts * stride;
      stride *= cells[d] + 2 * ghosts;
    }
    size_ = stride;
  }

  const Index<Dim>& cells() const { return cells_; }
  std::ptrdiff_t size() const { return size_; }  ///< length of a field, ghost layers included
  Step step(int d) const { return {strides_[d]}; }
  bool periodic(int d) const { return periodic_[d]; }
  /// Whether the two ends of the box along d are next to each other.
  bool wraps(const Box<Dim>& box, int d) const { return periodic_[d] && box.extent(d) == cells_[d]; }
  /// The position along d that i is a copy of; i itself on axes that are not periodic.
  int image(int d, int i) const {
    const int n = cells_[d];
    return periodic_[d] && n > 0 ? (i % n + n) % n : i;
  }
  Index<Dim> image(Index<Dim> i) const {
    for (int d = 0; d < Dim; ++d) i[d] = image(d, i[d]);
    return i;
  }
  template <class Tag>
  FlatIndex<Tag> image(FlatIndex<Tag> at) const {
    return {flat(image(multi(at.n)))};
  }

  /// Flat number of a multi-index; owned cells start at (0, ..., 0).
  std::ptrdiff_t flat(const Index<Dim>& i) const {
    std::ptrdiff_t n = origin_;
    for (int d = 0; d < Dim; ++d) n += i[d] * strides_[d];
    return n;
  }

  /// Multi-index of a flat number; inverse of flat().
  Index<Dim> multi(std::ptrdiff_t n) const {
    Index<Dim> i;
    for (int d = Dim - 1; d >= 0; --d) {
      i[d] = static_cast<int>(n / strides_[d]) - ghosts;
      n %= strides_[d];
    }
    return i;
  }

 private:
  Index<Dim> cells_;
  AxisFlags<Dim> periodic_;
  std::ptrdiff_t strides_[Dim] = {};
  std::ptrdiff_t origin_ = 0;
  std::ptrdiff_t size_ = 0;
};

}  // namespace quicksand
