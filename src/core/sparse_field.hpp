#pragma once
/// \file
/// Values at few positions of a grid.
#include <numeric>
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
    const Rows<Dim> rows(layout, box);
    std::vector<int> before(static_cast<std::size_t>(rows.count) + 1, 0);  // candidates in the rows before a row
    const auto for_each_row = [&](auto&& body) {
      for_each_number(rows.count, rows.count * rows.length,
                      [&](std::ptrdiff_t r) { body(rows.start(r), static_cast<std::size_t>(r)); });
    };
    for_each_row([&](std::ptrdiff_t start, std::size_t r) {
      const Index<Dim> first = layout.multi(start);
      for (int i = 0; i < rows.length; ++i) {
        Index<Dim> index = first;
        index[0] += i;
        const At at{start + i};
        number_[at] = candidate(at, index) ? before[r + 1]++ : none;
      }
    });
    std::partial_sum(before.begin(), before.end(), before.begin());
    std::vector<At> place(static_cast<std::size_t>(before.back()));
    for_each_row([&](std::ptrdiff_t start, std::size_t r) {
      for (At at{start}; at.n < start + rows.length; ++at.n) {
        if (!has(at)) continue;
        number_[at] += before[r];
        place[static_cast<std::size_t>(number_[at])] = at;
      }
    });
    // Candidates lie close together: threads share them evenly, not by rows.
    constexpr int cost = 64;
    values_.assign(place.size(), T{});
    for_each_number(before.back(), before.back() * std::ptrdiff_t{cost}, [&](std::ptrdiff_t k) {
      const auto number = static_cast<std::size_t>(k);
      const At at = place[number];
      if (!find(at, layout.multi(at.n), values_[number])) number_[at] = none;
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
