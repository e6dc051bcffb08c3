#include "solvers/banded_cholesky.hpp"

#include <array>
#include <numeric>

namespace quicksand {

template <int Dim>
BandOrder<Dim>::BandOrder(const Layout<Dim>& layout, const Box<Dim>& box) : layout_(layout), box_(box) {
  std::array<int, static_cast<std::size_t>(Dim)> axes{};
  std::iota(axes.begin(), axes.end(), 0);
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return box.extent(a) < box.extent(b); });
  int stride = 1;
  for (const int d : axes) {
    stride_[d] = stride;
    ring_[d] = layout.wraps(box, d) && box.extent(d) > 2;
    bandwidth_ += (ring_[d] ? 2 : 1) * (box.extent(d) > 1 ? stride : 0);
    stride *= box.extent(d);
  }
}

template <int Dim>
int BandOrder<Dim>::number(Index<Dim> i) const {
  int n = 0;
  for (int d = 0; d < Dim; ++d) {
    if (layout_.wraps(box_, d)) i[d] = layout_.image(d, i[d]);
    const int extent = box_.extent(d);
    int place = i[d] - box_.lo[d];
    if (place < 0 || place >= extent) return -1;
    if (ring_[d]) place = 2 * place < extent ? 2 * place : 2 * (extent - 1 - place) + 1;
    n += place * stride_[d];
  }
  return n;
}

BandedCholesky::BandedCholesky(int size, int bandwidth)
    : size_(size),
      bandwidth_(std::min(bandwidth, size - 1)),
      stride_(static_cast<std::size_t>(bandwidth_) + 1),
      // Columns near the end reach beyond it: room to spare keeps the loops free of tests.
      values_((static_cast<std::size_t>(size) + static_cast<std::size_t>(bandwidth_)) * stride_, 0.0) {}

bool BandedCholesky::factorize() {
  for (int j = 0; j < size_; ++j) {
    double* const column = &entry(j, 0);
    const double diagonal = column[0];
    if (!(diagonal > 0) || !std::isfinite(diagonal)) return false;
    for (int k = 1; k <= bandwidth_; ++k) {
      const double factor = column[k] / diagonal;
      if (factor == 0) continue;
      double* const target = &entry(j + k, 0);
      for (int i = k; i <= bandwidth_; ++i) target[i - k] -= factor * column[i];
    }
    for (int k = 1; k <= bandwidth_; ++k) column[k] /= diagonal;
  }
  return true;
}

void BandedCholesky::solve(std::vector<double>& x) const {
  x.resize(static_cast<std::size_t>(size_) + static_cast<std::size_t>(bandwidth_));
  for (int j = 0; j < size_; ++j) {
    const double* const column = &values_[static_cast<std::size_t>(j) * stride_];
    double* const from = &x[static_cast<std::size_t>(j)];
    for (int k = 1; k <= bandwidth_; ++k) from[k] -= column[k] * from[0];
  }
  std::fill(x.begin() + size_, x.end(), 0.0);
  for (int j = size_ - 1; j >= 0; --j) {
    const double* const column = &values_[static_cast<std::size_t>(j) * stride_];
    double* const from = &x[static_cast<std::size_t>(j)];
    double value = from[0] / column[0];
    for (int k = 1; k <= bandwidth_; ++k) value -= column[k] * from[k];
    from[0] = value;
  }
  x.resize(static_cast<std::size_t>(size_));
}

template class BandOrder<2>;
template class BandOrder<3>;

}  // namespace quicksand
