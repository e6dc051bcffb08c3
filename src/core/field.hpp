#pragma once
/// \file
/// Scalar fields on the cells, faces and nodes of a grid.
#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/index.hpp"
#include "core/layout.hpp"
#include "core/threads.hpp"

namespace quicksand {

/// Leaves new values unset, for their owner to set them: memory that is new to the process lies close to the processor
/// that writes to it first, which is to be the one whose thread works on that part of them.
template <class T>
struct UntouchedAllocator : std::allocator<T> {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  template <class U>
  struct rebind {                         // NOLINT(readability-identifier-naming): the standard's names
    using other = UntouchedAllocator<U>;  // NOLINT(readability-identifier-naming)
  };
  UntouchedAllocator() = default;
  template <class U>
  UntouchedAllocator(const UntouchedAllocator<U>&) noexcept {}
  template <class U>
  void construct(U*) noexcept {}
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// One value of type T per position of kind `At`, ghost layers included.
template <class At, class T = double>
class Field {
 public:
  using Values = std::vector<T, UntouchedAllocator<T>>;

  Field() = default;
  template <int Dim>
  explicit Field(const Layout<Dim>& layout, T value = T{}) : values_(static_cast<std::size_t>(layout.size())) {
    fill(value);
  }
  Field(const Field& other) : values_(other.values_.size()) { copy(other); }
  Field& operator=(const Field& other) {
    if (this == &other) return *this;
    values_.resize(other.values_.size());
    copy(other);
    return *this;
  }
  Field(Field&&) noexcept = default;
  Field& operator=(Field&&) noexcept = default;
  ~Field() = default;

  T& operator[](At at) { return values_[static_cast<std::size_t>(at.n)]; }
  const T& operator[](At at) const { return values_[static_cast<std::size_t>(at.n)]; }

  void fill(T value) {
    in_parts([&](std::ptrdiff_t first, std::ptrdiff_t last) {
      std::fill(values_.begin() + first, values_.begin() + last, value);
    });
  }
  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(values_.size()); }
  Values& values() { return values_; }  ///< of all positions, for storing; of a fixed length

 private:
  template <class Body>
  void in_parts(Body&& body) {
    constexpr std::ptrdiff_t smallest_shared = 1 << 16;  // starting threads costs more than to write fewer values
    if (size() >= smallest_shared) {
      share_among_threads(size(), body);
    } else {
      body(0, size());
    }
  }
  void copy(const Field& other) {
    in_parts([&](std::ptrdiff_t first, std::ptrdiff_t last) {
      std::copy(other.values_.begin() + first, other.values_.begin() + last, values_.begin() + first);
    });
  }

  Values values_;
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
