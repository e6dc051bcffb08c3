#pragma once
/// \file
/// Direct solution of symmetric positive definite systems whose entries lie near the diagonal: small or slender boxes.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/field.hpp"
#include "core/layout.hpp"
#include "core/loop.hpp"

namespace quicksand {

/// Numbers the points of a box so that neighbours have near numbers: the shortest axis runs fastest, and periodic axes
/// run from both ends in turn.
template <int Dim>
class BandOrder {
 public:
  BandOrder(const Layout<Dim>& layout, const Box<Dim>& box);

  int size() const { return static_cast<int>(box_.size()); }
  /// Largest difference between the numbers of neighbours, those across corners included.
  int bandwidth() const { return bandwidth_; }
  /// Number of a point; of one beyond the box the number of the point it is a copy of, -1 if there is none.
  int number(Index<Dim> i) const;

  /// Calls body(At, number) for all points of the box.
  template <class At, class Body>
  void for_each(Body&& body) const {
    const Rows<Dim> rows(layout_, box_);
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      const std::ptrdiff_t start = rows.start(r);
      Index<Dim> index = layout_.multi(start);
      for (int i = 0; i < rows.length; ++i, ++index[0]) body(At{start + i}, index, number(index));
    }
  }

 private:
  Layout<Dim> layout_;
  Box<Dim> box_;
  int stride_[Dim] = {};
  AxisFlags<Dim> ring_;
  int bandwidth_ = 0;
};

/// Factors L D L^T of a symmetric matrix. The work is size * bandwidth^2, that of a solution size * bandwidth.
class BandedCholesky {
 public:
  /// A matrix of zeros.
  BandedCholesky(int size, int bandwidth);
  /// Adds to the entry at (row, column) and its mirror image, for |row - column| <= bandwidth.
  void add(int row, int column, double value) { entry(std::min(row, column), std::abs(row - column)) += value; }
  /// Replaces the matrix by its factors. Returns false where it is not positive definite to round-off.
  bool factorize();
  /// x <- matrix^-1 x, after factorize().
  void solve(std::vector<double>& x) const;

 private:
  double& entry(int column, int below) {
    return values_[static_cast<std::size_t>(column) * stride_ + static_cast<std::size_t>(below)];
  }

  int size_, bandwidth_;
  std::size_t stride_;
  std::vector<double> values_;  // column by column, from the diagonal down
};

}  // namespace quicksand
