#pragma once
/// \file
/// Threaded loops over boxes of the index space.
///
/// Reductions add row by row and then the rows in order, so that a result does not depend on the number of threads.
#include <algorithm>
#include <type_traits>
#include <vector>

#include "core/index.hpp"
#include "core/layout.hpp"
#include "core/threads.hpp"

namespace quicksand {

namespace detail {

/// Loops over fewer points than this run on one thread: starting a team costs more than they do.
inline constexpr std::ptrdiff_t smallest_threaded_loop = QUICKSAND_SMALLEST_THREADED_LOOP;

}  // namespace detail

/// Calls body(r) for r in [0, count), in threads where the work is worth it.
/// \param points  the work, in points of a simple loop
template <class Body>
void for_each_number(std::ptrdiff_t count, std::ptrdiff_t points, Body&& body) {
  const auto run = [&body](std::ptrdiff_t first, std::ptrdiff_t last) {
    for (std::ptrdiff_t r = first; r < last; ++r) body(r);
  };
  if (points >= detail::smallest_threaded_loop) {
    share_among_threads(count, run);
  } else {
    run(0, count);
  }
}

/// Calls body(i) for i in [0, count), in vector registers where the body allows: no call needs what another has done.
template <class Body>
void for_each_side_by_side(int count, Body&& body) {
#pragma omp simd
  for (int i = 0; i < count; ++i) body(i);
}

/// Rows (runs along x) of a box, numbered 0 ... count-1: for loops over rows in threads, or serial in a fixed order.
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
  /// Calls body(flat number of the first point) for every row, in threads.
  /// \param cost  of a point, in that of a point of a simple loop
  template <class Body>
  void for_each(Body&& body, int cost = 1) const {
    for_each_number(count, count * length * cost, [&](std::ptrdiff_t r) { body(start(r)); });
  }
};

namespace detail {

/// body(At), or body(At, Index) where it takes the multi-index as well. \param i  of the point, or of one of its row,
/// `x` points before it
template <class At, int Dim, class Body>
auto at_point(Body&& body, At p, Index<Dim> i, int x) {
  if constexpr (std::is_invocable_v<Body, At, const Index<Dim>&>) {
    i[0] += x;
    return body(p, i);
  } else {
    return body(p);
  }
}

/// Multi-index of the first point of a row, for bodies that take it.
template <class At, int Dim, class Body>
Index<Dim> row_index(const Layout<Dim>& layout, std::ptrdiff_t start) {
  if constexpr (std::is_invocable_v<Body, At, const Index<Dim>&>) return layout.multi(start);
  return {};
}

}  // namespace detail

/// Calls body(At), or body(At, Index) if it takes the multi-index as well, for every point of the box. The body writes
/// only to its own point.
template <class At, int Dim, class Body>
void for_each(const Layout<Dim>& layout, const Box<Dim>& box, Body&& body) {
  const Rows<Dim> rows(layout, box);
  rows.for_each([&](std::ptrdiff_t start) {
    const Index<Dim> first = detail::row_index<At, Dim, Body&>(layout, start);
#pragma omp simd
    for (int i = 0; i < rows.length; ++i) detail::at_point(body, At{start + i}, first, i);
  });
}

namespace detail {

/// The points along one axis of a box that belong to one of three colours: even ones, odd ones and, where the ends of
/// an odd number of points meet, the last one by itself. No two of a colour are next to each other.
struct ColouredAxis {
  int first;
  int count;

  template <int Dim>
  ColouredAxis(const Layout<Dim>& layout, const Box<Dim>& box, int d, int colour) {
    const int apart = layout.wraps(box, d) ? box.extent(d) % 2 : 0;
    first = colour < 2 ? box.lo[d] + colour : box.hi[d] - apart;
    count = colour < 2 ? std::max(box.hi[d] - apart - first + 1, 0) / 2 : apart;
  }
};

/// Calls body(Index) in threads for the first point of every row of a colour, which is one on each axis but x; a row
/// counts as `points` points.
template <int Dim, class Body>
void for_each_row_of_colour(const Layout<Dim>& layout, const Box<Dim>& box, int pass, std::ptrdiff_t points,
                            Body&& body) {
  Index<Dim> first = box.lo;
  Index<Dim> n;
  std::ptrdiff_t count = 1;
  for (int d = 1, rest = pass; d < Dim; ++d, rest /= 3) {
    const ColouredAxis axis(layout, box, d, rest % 3);
    first[d] = axis.first;
    n[d] = axis.count;
    count *= n[d];
  }
  for_each_number(count, count * points, [&](std::ptrdiff_t r) {
    Index<Dim> index = first;
    for (int d = 1; d < Dim; ++d) {
      index[d] += 2 * static_cast<int>(r % n[d]);
      r /= n[d];
    }
    body(index);
  });
}

}  // namespace detail

/// Like for_each with body(At, Index), in passes such that a pass visits every second point along each axis: a body may
/// also write to points that neighbours of the same pass do not touch (scatter from an element to its corners). The
/// order of additions to a point is the same for any number of threads.
template <class At, int Dim, class Body>
void for_each_coloured(const Layout<Dim>& layout, const Box<Dim>& box, Body&& body) {
  constexpr int passes = Dim == 2 ? 9 : 27;
  for (int pass = 0; pass < passes; ++pass) {
    const detail::ColouredAxis row(layout, box, 0, pass % 3);
    if (row.count == 0) continue;
    detail::for_each_row_of_colour(layout, box, pass / 3, row.count * (1 << Dim), [&](Index<Dim> index) {
      index[0] = row.first;
      const std::ptrdiff_t start = layout.flat(index);
      for (int i = 0; i < row.count; ++i, index[0] += 2) body(At{start + 2 * i}, index);
    });
  }
}

/// Calls body(Index) for the first point of every row (run along x) of the box, in passes such that a pass visits every
/// second row along each other axis: a body may write to its own row and to rows next to it on one side.
/// \param cost  of a point, in that of a point of a simple loop
template <int Dim, class Body>
void for_each_coloured_row(const Layout<Dim>& layout, const Box<Dim>& box, int cost, Body&& body) {
  constexpr int passes = Dim == 2 ? 3 : 9;
  if (box.empty()) return;
  for (int pass = 0; pass < passes; ++pass) {
    detail::for_each_row_of_colour(layout, box, pass, box.extent(0) * static_cast<std::ptrdiff_t>(cost), body);
  }
}

/// Sum of f(At), or f(At, Index), over the box.
template <class At, int Dim, class F>
double sum(const Layout<Dim>& layout, const Box<Dim>& box, F&& f) {
  const Rows<Dim> rows(layout, box);
  std::vector<double> partial(static_cast<std::size_t>(rows.count), 0.0);
  for_each_number(rows.count, rows.count * rows.length, [&](std::ptrdiff_t r) {
    const std::ptrdiff_t start = rows.start(r);
    const Index<Dim> first = detail::row_index<At, Dim, F&>(layout, start);
    double total = 0;
#pragma omp simd reduction(+ : total)
    for (int i = 0; i < rows.length; ++i) total += detail::at_point(f, At{start + i}, first, i);
    partial[static_cast<std::size_t>(r)] = total;
  });
  double total = 0;
  for (const double p : partial) total += p;
  return total;
}

/// Largest f(At), or f(At, Index), over the box, at least `floor`. NaN is not seen: check finiteness apart.
template <class At, int Dim, class F>
double maximum(const Layout<Dim>& layout, const Box<Dim>& box, double floor, F&& f) {
  const Rows<Dim> rows(layout, box);
  std::vector<double> partial(static_cast<std::size_t>(rows.count), floor);
  for_each_number(rows.count, rows.count * rows.length, [&](std::ptrdiff_t r) {
    const std::ptrdiff_t start = rows.start(r);
    const Index<Dim> first = detail::row_index<At, Dim, F&>(layout, start);
    double largest = floor;
    for (int i = 0; i < rows.length; ++i) {
      largest = std::max(largest, detail::at_point(f, At{start + i}, first, i));
    }
    partial[static_cast<std::size_t>(r)] = largest;
  });
  double largest = floor;
  for (const double p : partial) largest = std::max(largest, p);
  return largest;
}

}  // namespace quicksand
