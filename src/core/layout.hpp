#pragma once
/// \file
/// How multi-indices map to flat indices: x fastest, `ghosts` layers around the owned cells.
#include "core/index.hpp"

namespace quicksand {

/// Number of ghost layers around the owned cells: a limited slope in the first ghost cell needs the second.
inline constexpr int ghosts = 2;

/// Strides and origin of the ghosted index space that all fields of one grid share.
template <int Dim>
class Layout {
 public:
  Layout() = default;
  /// \param cells owned cells along each axis
  explicit Layout(const Index<Dim>& cells) : cells_(cells) {
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
  std::ptrdiff_t strides_[Dim] = {};
  std::ptrdiff_t origin_ = 0;
  std::ptrdiff_t size_ = 0;
};

}  // namespace quicksand
