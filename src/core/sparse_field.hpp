#pragma once
/// \file
/// Values at few positions of a grid.
#include <vector>

#include "core/field.hpp"
#include "core/loop.hpp"
#include "core/periodic.hpp"

namespace quicksand {

/// Values of type T at some positions of kind `At`, stored one after another, and four bytes for every other position.
template <class At, class T>
class SparseField {
 public:
  SparseField() = default;
  template <int Dim>
  explicit SparseField(const Layout<Dim>& layout) : number_(layout, none) {}

  bool has(At at) const { return number_[at] != none; }
  /// The value at a position that has one.
  const T& operator[](At at) const { return values_[static_cast<std::size_t>(number_[at])]; }
  /// Sets the values anew: at the points of the box where candidate(At, Index), unless find(At, Index, T&) says false.
  /// The value that find() is given is T{}.
  template <int Dim, class Candidate, class Find>
  void find(const Layout<Dim>& layout, const Box<Dim>& box, Candidate&& candidate, Find&& find) {
    number_.fill(none);
    for_each<At>(layout, box, [&](At at, const Index<Dim>& i) { number_[at] = candidate(at, i) ? 0 : none; });
    int count = 0;  // in order of the points, whatever the number of threads: serial
    const Rows<Dim> rows(layout, box);
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      const std::ptrdiff_t start = rows.start(r);
      for (int i = 0; i < rows.length; ++i) {
        int& number = number_[At{start + i}];
        if (number != none) number = count++;
      }
    }
    values_.assign(static_cast<std::size_t>(count), T{});
    for_each<At>(layout, box, [&](At at, const Index<Dim>& i) {
      if (!has(at)) return;
      if (!find(at, i, values_[static_cast<std::size_t>(number_[at])])) number_[at] = none;
    });
  }
  /// Gives the layer around a box the values at the other ends of the axes on which it wraps.
  template <int Dim>
  void wrap(const Layout<Dim>& layout, const Box<Dim>& box) {
    quicksand::wrap(layout, box, number_);
  }

 private:
  static constexpr int none = -1;
  Field<At, int> number_;
  std::vector<T> values_;
};

}  // namespace quicksand
