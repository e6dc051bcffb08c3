#pragma once
/// \file
/// Scalar fields on the cells, faces and nodes of a grid.
#include <algorithm>
#include <array>
#include <vector>

#include "core/index.hpp"
#include "core/layout.hpp"

namespace quicksand {

/// One value of type T per position of kind `At`, ghost layers included.
template <class At, class T = double>
class Field {
 public:
  Field() = default;
  template <int Dim>
  explicit Field(const Layout<Dim>& layout, T value = T{}) : values_(static_cast<std::size_t>(layout.size()), value) {}

  T& operator[](At at) { return values_[static_cast<std::size_t>(at.n)]; }
  const T& operator[](At at) const { return values_[static_cast<std::size_t>(at.n)]; }

  void fill(T value) { std::fill(values_.begin(), values_.end(), value); }
  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(values_.size()); }
  std::vector<T>& values() { return values_; }  ///< of all positions, for storing; of a fixed length

 private:
  std::vector<T> values_;
};

using CellField = Field<Cell>;
using NodeField = Field<Node>;
using FaceField = Field<Face>;
using CellMask = Field<Cell, unsigned char>;
using NodeMask = Field<Node, unsigned char>;

/// `Dim` fields: the components of a vector in cells, or one field of faces per axis.
template <int Dim, class At>
struct Components {
  std::array<Field<At>, static_cast<std::size_t>(Dim)> component;

  Components() = default;
  explicit Components(const Layout<Dim>& layout, double value = 0) { component.fill(Field<At>(layout, value)); }
  Field<At>& operator[](int d) { return component[static_cast<std::size_t>(d)]; }
  const Field<At>& operator[](int d) const { return component[static_cast<std::size_t>(d)]; }
  Vec<Dim> at(At p) const {
    Vec<Dim> v;
    for (int d = 0; d < Dim; ++d) v[d] = (*this)[d][p];
    return v;
  }
};

template <int Dim>
using CellVectors = Components<Dim, Cell>;
template <int Dim>
using FaceScalars = Components<Dim, Face>;

}  // namespace quicksand
