#pragma once
/// \file
/// Flat typed indices, multi-indices and index boxes.
///
/// All fields of a grid share one ghosted index space. A cell, the face on its low side along an axis and the
/// node at its low corner carry the same flat number but different types, so that a cell can't index a node field.
#include <cstddef>
#include <type_traits>
#include <utility>

namespace quicksand {

/// A displacement in the flat index space: the stride along an axis or a sum of strides.
struct Step {
  std::ptrdiff_t n = 0;
  friend constexpr Step operator+(Step a, Step b) { return {a.n + b.n}; }
  friend constexpr Step operator-(Step a) { return {-a.n}; }
  friend constexpr Step operator*(int k, Step a) { return {k * a.n}; }
};

/// A position in the flat index space; `Tag` says of what kind.
template <class Tag>
struct FlatIndex {
  std::ptrdiff_t n = 0;
  friend constexpr FlatIndex operator+(FlatIndex a, Step s) { return {a.n + s.n}; }
  friend constexpr FlatIndex operator-(FlatIndex a, Step s) { return {a.n - s.n}; }
  friend constexpr bool operator==(FlatIndex a, FlatIndex b) { return a.n == b.n; }
};

using Cell = FlatIndex<struct CellTag>;
using Face = FlatIndex<struct FaceTag>;  ///< face on the low side of the cell with the same number, along a named axis
using Node = FlatIndex<struct NodeTag>;  ///< node at the low corner of the cell with the same number

constexpr Face low_face(Cell c) { return {c.n}; }
constexpr Node low_node(Cell c) { return {c.n}; }
constexpr Cell high_cell(Face f) { return {f.n}; }  ///< cell above the face; the one below is high_cell(f) - step(d)
constexpr Cell high_cell(Node n) { return {n.n}; }  ///< cell whose low corner is the node

/// Multi-index of `Dim` integers.
template <int Dim>
struct Index {
  int v[Dim] = {};
  constexpr int& operator[](int d) { return v[d]; }
  constexpr int operator[](int d) const { return v[d]; }
  friend constexpr Index operator+(Index a, const Index& b) {
    for (int d = 0; d < Dim; ++d) a[d] += b[d];
    return a;
  }
  friend constexpr Index operator-(Index a, const Index& b) {
    for (int d = 0; d < Dim; ++d) a[d] -= b[d];
    return a;
  }
  friend constexpr bool operator==(const Index&, const Index&) = default;
};

/// The index k places on along axis d.
template <int Dim>
constexpr Index<Dim> shifted(Index<Dim> i, int d, int k) {
  i[d] += k;
  return i;
}

/// Point or vector of `Dim` reals.
template <int Dim>
struct Vec {
  double v[Dim] = {};
  constexpr double& operator[](int d) { return v[d]; }
  constexpr double operator[](int d) const { return v[d]; }
  friend constexpr bool operator==(const Vec&, const Vec&) = default;
};

/// One flag per axis.
template <int Dim>
struct AxisFlags {
  bool v[Dim] = {};
  constexpr bool& operator[](int d) { return v[d]; }
  constexpr bool operator[](int d) const { return v[d]; }
  friend constexpr bool operator==(const AxisFlags&, const AxisFlags&) = default;
};

/// Calls body(d) for the axes 0 ... Dim - 1, each as a constant: loops inside then are compiled for their axis, and one
/// of which each point is computed from the 1-D metrics runs in vector registers.
template <int Dim, class Body>
void for_each_axis(Body&& body) {
  [&]<int... axis>(std::integer_sequence<int, axis...>) { (body(std::integral_constant<int, axis>{}), ...); }
  (std::make_integer_sequence<int, Dim>{});
}

/// Half-open box of multi-indices, lo <= i < hi.
template <int Dim>
struct Box {
  Index<Dim> lo;
  Index<Dim> hi;

  constexpr int extent(int d) const { return hi[d] > lo[d] ? hi[d] - lo[d] : 0; }
  constexpr std::ptrdiff_t size() const {
    std::ptrdiff_t n = 1;
    for (int d = 0; d < Dim; ++d) n *= extent(d);
    return n;
  }
  constexpr bool empty() const { return size() == 0; }
  constexpr bool contains(const Index<Dim>& i) const {
    for (int d = 0; d < Dim; ++d) {
      if (i[d] < lo[d] || i[d] >= hi[d]) return false;
    }
    return true;
  }
  friend constexpr bool operator==(const Box&, const Box&) = default;
};

/// The box with `k` more layers on every side (fewer for negative k).
template <int Dim>
constexpr Box<Dim> grow(Box<Dim> box, int k) {
  for (int d = 0; d < Dim; ++d) {
    box.lo[d] -= k;
    box.hi[d] += k;
  }
  return box;
}

/// The box with `k` more layers on the high side of axis d.
template <int Dim>
constexpr Box<Dim> extend_high(Box<Dim> box, int d, int k = 1) {
  box.hi[d] += k;
  return box;
}

/// The part that two boxes share (empty where they do not meet).
template <int Dim>
constexpr Box<Dim> intersect(Box<Dim> a, const Box<Dim>& b) {
  for (int d = 0; d < Dim; ++d) {
    a.lo[d] = a.lo[d] > b.lo[d] ? a.lo[d] : b.lo[d];
    a.hi[d] = a.hi[d] < b.hi[d] ? a.hi[d] : b.hi[d];
  }
  return a;
}

}  // namespace quicksand
