#pragma once
/// \file
/// Threaded loops over boxes of the index space: the only place with OpenMP pragmas.
///
/// Reductions add row by row and then the rows in order, so that a result does not depend on the number of threads.
#include <algorithm>
#include <type_traits>
#include <vector>

#include "core/index.hpp"
#include "core/layout.hpp"

namespace quicksand {

namespace detail {

/// Loops over fewer points than this run on one thread: starting a team costs more than they do.
inline constexpr std::ptrdiff_t smallest_threaded_loop = QUICKSAND_SMALLEST_THREADED_LOOP;

}  // namespace detail

/// Rows (runs along x) of a box, numbered 0 ... count-1; for serial loops in a fixed order.
template <int Dim>
struct Rows {
  const Layout<Dim>& layout;
  Box<Dim> box;
  std::ptrdiff_t count;
  int length;

  Rows(const Layout<Dim>& l, const Box<Dim>& b) : layout(l), box(b), count(1), length(b.extent(0)) {
    for (int d = 1; d < Dim; ++d) count *= b.extent(d);
    if (length == 0) count = 0;
  }
  /// Flat number of the first point of row r.
  std::ptrdiff_t start(std::ptrdiff_t r) const {
    // Short divisions, and none in the plane: they would cost as much as a short row.
    Index<Dim> i = box.lo;
    auto rest = static_cast<unsigned>(r);
    for (int d = 1; d < Dim - 1; ++d) {
      const auto extent = static_cast<unsigned>(std::max(box.extent(d), 1));
      i[d] += static_cast<int>(rest % extent);
      rest /= extent;
    }
    i[Dim - 1] += static_cast<int>(rest);
    return layout.flat(i);
  }
  bool worth_threads() const { return count * length >= detail::smallest_threaded_loop; }
};

/// Calls body(At) for every point of the box. The body writes only to its own point.
template <class At, int Dim, class Body>
void for_each(const Layout<Dim>& layout, const Box<Dim>& box, Body&& body) {
  const Rows<Dim> rows(layout, box);
#pragma omp parallel for schedule(static) if (rows.worth_threads())
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    const std::ptrdiff_t start = rows.start(r);
#pragma omp simd
    for (int i = 0; i < rows.length; ++i) body(At{start + i});
  }
}

/// Calls body(At, Index) for every point of the box; for loops that need the multi-index (1-D metrics, shapes).
template <class At, int Dim, class Body>
void for_each_indexed(const Layout<Dim>& layout, const Box<Dim>& box, Body&& body) {
  const Rows<Dim> rows(layout, box);
#pragma omp parallel for schedule(static) if (rows.worth_threads())
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    const std::ptrdiff_t start = rows.start(r);
    Index<Dim> index = layout.multi(start);
    for (int i = 0; i < rows.length; ++i, ++index[0]) body(At{start + i}, index);
  }
}

/// Like for_each_indexed, in passes such that a pass visits every second point along each axis: a body may also write
/// to points that neighbours of the same pass do not touch (scatter from an element to its corners). The order of
/// additions to a point is the same for any number of threads.
template <class At, int Dim, class Body>
void for_each_coloured(const Layout<Dim>& layout, const Box<Dim>& box, Body&& body) {
  constexpr int passes = Dim == 2 ? 9 : 27;
  for (int pass = 0; pass < passes; ++pass) {
    Index<Dim> first = box.lo;
    std::ptrdiff_t count = 1;
    Index<Dim> n;
    for (int d = 0, rest = pass; d < Dim; ++d, rest /= 3) {
      // Even points, odd points and, where the ends of an odd number of points meet, the last one by itself.
      const int colour = rest % 3;
      const int apart = layout.wraps(box, d) ? box.extent(d) % 2 : 0;
      first[d] = colour < 2 ? box.lo[d] + colour : box.hi[d] - apart;
      n[d] = colour < 2 ? std::max(box.hi[d] - apart - first[d] + 1, 0) / 2 : apart;
      if (d > 0) count *= n[d];
    }
    if (n[0] == 0) continue;
#pragma omp parallel for schedule(static) if (count * n[0] * (1 << Dim) >= detail::smallest_threaded_loop)
    for (std::ptrdiff_t r = 0; r < count; ++r) {
      Index<Dim> index = first;
      std::ptrdiff_t rest = r;
      for (int d = 1; d < Dim; ++d) {
        index[d] += 2 * static_cast<int>(rest % n[d]);
        rest /= n[d];
      }
      const std::ptrdiff_t start = layout.flat(index);
      for (int i = 0; i < n[0]; ++i, index[0] += 2) body(At{start + 2 * i}, index);
    }
  }
}

/// Sum of f(At) over the box.
template <class At, int Dim, class F>
double sum(const Layout<Dim>& layout, const Box<Dim>& box, F&& f) {
  const Rows<Dim> rows(layout, box);
  std::vector<double> partial(static_cast<std::size_t>(rows.count), 0.0);
#pragma omp parallel for schedule(static) if (rows.worth_threads())
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    const std::ptrdiff_t start = rows.start(r);
    double total = 0;
#pragma omp simd reduction(+ : total)
    for (int i = 0; i < rows.length; ++i) total += f(At{start + i});
    partial[static_cast<std::size_t>(r)] = total;
  }
  double total = 0;
  for (const double p : partial) total += p;
  return total;
}

/// Largest f(At) over the box, at least `floor`. NaN is not seen: check finiteness apart.
template <class At, int Dim, class F>
double maximum(const Layout<Dim>& layout, const Box<Dim>& box, double floor, F&& f) {
  const Rows<Dim> rows(layout, box);
  double largest = floor;
#pragma omp parallel for schedule(static) reduction(max : largest) if (rows.worth_threads())
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    const std::ptrdiff_t start = rows.start(r);
    double row_largest = floor;
    for (int i = 0; i < rows.length; ++i) row_largest = std::max(row_largest, f(At{start + i}));
    largest = std::max(largest, row_largest);
  }
  return largest;
}

}  // namespace quicksand
