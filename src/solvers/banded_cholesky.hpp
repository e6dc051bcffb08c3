#pragma once
/// \file
/// Direct solution of symmetric positive definite systems whose entries lie near the diagonal: small or slender boxes.
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/field.hpp"
#include "core/layout.hpp"
#include "core/loop.hpp"
#include "core/pack.hpp"

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

  /// Calls body(At, Index, number) for all points of the box, in threads: a body writes to what is its point's own.
  template <class At, class Body>
  void for_each(Body&& body) const {
    constexpr int cost = 16;
    const Rows<Dim> rows(layout_, box_);
    rows.for_each(
        [&](std::ptrdiff_t start) {
          Index<Dim> i = layout_.multi(start);
          for (int k = 0; k < rows.length; ++k, ++i[0]) body(At{start + k}, i, number(i));
        },
        cost);
  }

 private:
  Layout<Dim> layout_;
  Box<Dim> box_;
  int stride_[Dim] = {};
  AxisFlags<Dim> ring_;
  int bandwidth_ = 0;
};

/// Factors L D L^T of a symmetric matrix. The work is size * bandwidth^2, that of a solution size * bandwidth.
///
/// Long bands are eliminated from both ends at once, on two threads where there are as many; what is between the
/// halves, as many unknowns as the band is wide, comes last. The order is the same for any number of threads.
class BandedCholesky {
 public:
  /// A matrix whose entries are not set yet: those of every unknown begin with begin().
  BandedCholesky(int size, int bandwidth);
  /// How many numbers are held for an unknown.
  static int numbers_per_unknown(int bandwidth);
  /// Sets all entries to zero that belong to an unknown. Unknowns may be begun and added to at the same time.
  void begin(int unknown) {
    const bool first = unknown < ends_[0] + middle_;
    band_[first ? 0 : 1].clear_column(first ? unknown : size_ - 1 - unknown);
  }
  /// The one of two unknowns that their entry belongs to.
  int owner(int a, int b) const { return std::max(a, b) < ends_[0] + middle_ ? std::min(a, b) : std::max(a, b); }
  /// Adds to the entry at (row, column) and its mirror image, for |row - column| <= bandwidth, once its owner has
  /// begun.
  void add(int row, int column, double value) {
    const int low = std::min(row, column);
    const int high = std::max(row, column);
    const bool first = high < ends_[0] + middle_;
    (first ? band_[0].entry(low, high - low) : band_[1].entry(size_ - 1 - high, high - low)) += value;
  }
  /// Replaces the matrix by its factors. Returns false where it is not positive definite to round-off.
  bool factorize();
  /// x <- matrix^-1 x, after factorize().
  void solve(std::vector<double>& x) const;

 private:
  /// The lower triangle of a banded matrix, column by column from the diagonal down. Zeros beyond the band and the
  /// matrix let loops take a pack of rows and a panel of columns at a time; rows of the same number lie at the same
  /// place in their packs in all columns. An eliminated column holds a column of L and, on the diagonal, the inverse of
  /// D's entry.
  class Band {
   public:
    Band() = default;
    /// Of values that are not set yet.
    Band(int size, int bandwidth);
    /// How many zeros must follow the unknowns in an array.
    static int excess(int bandwidth);
    void clear_column(int j) { std::fill_n(column(j) + j, stride_ + 1, 0.0); }
    /// Clears the columns from the first one on to the end.
    void clear_from(int first);
    double& entry(int column, int below) { return this->column(column)[column + below]; }
    /// Eliminates the columns [first, last). Returns false where a pivot is not positive.
    bool eliminate(int first, int last);
    /// Forward and backward substitution with the columns [first, last).
    void substitute(int first, int last, double* x) const;
    void substitute_back(int first, int last, double* x) const;

   private:
    /// Row i of column j is column(j)[i].
    double* column(int j) { return reinterpret_cast<double*>(values_.data()) + j * stride_; }
    const double* column(int j) const { return reinterpret_cast<const double*>(values_.data()) + j * stride_; }
    bool eliminate_panel(int first, int count, double* inverse);

    int bandwidth_ = 0;
    std::ptrdiff_t stride_ = 0;  ///< a multiple of the numbers in a pack, so that rows keep their places
    std::vector<Pack, UntouchedAllocator<Pack>> values_;
  };

  /// Calls body(0) and body(1) for the two halves, in threads where so many operations are worth it.
  template <class Body>
  void for_halves(double operations, Body&& body) const;

  int size_, bandwidth_;
  int middle_;    ///< unknowns between the halves, the last of either; all of them where there is one half
  int ends_[2];   ///< unknowns of the halves
  Band band_[2];  ///< of a half and the middle, from the first unknown up and from the last one down
};

}  // namespace quicksand
