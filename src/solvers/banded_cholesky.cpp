#include "solvers/banded_cholesky.hpp"

#include <Eigen/Dense>
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

namespace {

/// Columns that are eliminated together: their updates of another column take one pass over it.
constexpr int panel = 4;
/// A band has two halves where it is so many times as long as wide.
constexpr int least_slenderness = 8;
/// Operations that count as a point of a simple loop. Halves are worth a second thread when they take some hundred
/// microseconds, because much that is serial comes between them.
constexpr double operations_per_point = 50;

}  // namespace

// Columns near the end reach beyond it, and those of a panel beyond the band: zeros there keep the loops free of tests.
BandedCholesky::Band::Band(int size, int bandwidth)
    : bandwidth_(bandwidth),
      stride_(static_cast<std::size_t>(bandwidth + panel)),
      values_(static_cast<std::size_t>(size + bandwidth + panel) * stride_) {}

bool BandedCholesky::Band::eliminate(int first, int last) {
  for (int j = first; j < last; j += panel) {
    const int count = std::min(panel, last - j);
    const double* column[panel];  // from the panel's first row on, as far as the column has it
    double diagonal[panel];
    for (int m = 0; m < count; ++m) {
      double* const own = &entry(j + m, 0);
      for (int l = 0; l < m; ++l) {
        const double factor = column[l][m] / diagonal[l];
        for (int i = 0; i <= bandwidth_ - (m - l); ++i) own[i] -= factor * column[l][m + i];
      }
      column[m] = own - m;
      diagonal[m] = own[0];
      if (!(diagonal[m] > 0) || !std::isfinite(diagonal[m])) return false;
    }
    for (int m = count; m < panel; ++m) {
      column[m] = column[0];
      diagonal[m] = INFINITY;
    }
    for (int k = count; k < bandwidth_ + count; ++k) {
      double factor[panel];
      bool couples = false;
      for (int m = 0; m < panel; ++m) {
        factor[m] = column[m][k] / diagonal[m];
        couples = couples || factor[m] != 0;
      }
      if (!couples) continue;
      double* const target = &entry(j + k, 0);
      const double* const c0 = column[0] + k;
      const double* const c1 = column[1] + k;
      const double* const c2 = column[2] + k;
      const double* const c3 = column[3] + k;
      const int rows = bandwidth_ + count - k;
      for (int i = 0; i < rows; ++i) {
        target[i] = target[i] - factor[0] * c0[i] - factor[1] * c1[i] - factor[2] * c2[i] - factor[3] * c3[i];
      }
    }
    for (int m = 0; m < count; ++m) {
      double* const own = &entry(j + m, 0);
      for (int k = 1; k <= bandwidth_; ++k) own[k] /= diagonal[m];
    }
  }
  return true;
}

void BandedCholesky::Band::substitute(int first, int last, double* x) const {
  for (int j = first; j < last; ++j) {
    const double* const column = &values_[static_cast<std::size_t>(j) * stride_];
    double* const from = x + j;
    for (int k = 1; k <= bandwidth_; ++k) from[k] -= column[k] * from[0];
  }
}

void BandedCholesky::Band::substitute_back(int first, int last, double* x) const {
  using Entries = Eigen::Map<const Eigen::VectorXd>;
  for (int j = last - 1; j >= first; --j) {
    const double* const column = &values_[static_cast<std::size_t>(j) * stride_];
    x[j] = x[j] / column[0] - Entries(column + 1, bandwidth_).dot(Entries(x + j + 1, bandwidth_));
  }
}

template <class Body>
void BandedCholesky::for_halves(double operations, Body&& body) const {
  for_each_number(2, static_cast<std::ptrdiff_t>(operations / operations_per_point),
                  [&](std::ptrdiff_t half) { body(static_cast<std::size_t>(half)); });
}

BandedCholesky::BandedCholesky(int size, int bandwidth)
    : size_(size), bandwidth_(std::clamp(bandwidth, 0, std::max(size - 1, 0))) {
  const bool halves = size_ > least_slenderness * bandwidth_;
  middle_ = halves ? bandwidth_ : size_;
  ends_[0] = (size_ - middle_) / 2;
  ends_[1] = size_ - middle_ - ends_[0];
  band_[0] = Band(ends_[0] + middle_, bandwidth_);
  if (halves) band_[1] = Band(ends_[1] + middle_, bandwidth_);
  for_halves(1.0 * size_ * bandwidth_, [&](std::size_t half) { band_[half].clear(); });
}

bool BandedCholesky::factorize() {
  bool definite[2];
  for_halves(1.0 * size_ * bandwidth_ * bandwidth_,
             [&](std::size_t half) { definite[half] = band_[half].eliminate(0, ends_[half]); });
  if (!definite[0] || !definite[1]) return false;
  // What the upper half does to the middle.
  for (int a = 0; ends_[1] > 0 && a < middle_; ++a) {
    for (int b = std::max(a - bandwidth_, 0); b <= a; ++b) {
      band_[0].entry(ends_[0] + b, a - b) += band_[1].entry(ends_[1] + middle_ - 1 - a, a - b);
    }
  }
  return band_[0].eliminate(ends_[0], ends_[0] + middle_);
}

void BandedCholesky::solve(std::vector<double>& x) const {
  const auto unknowns = [&](std::size_t half) { return ends_[half] + middle_; };
  std::vector<double> part[2];
  const bool halves = ends_[1] > 0;
  for (std::size_t half = 0; half < (halves ? 2 : 1); ++half) {
    part[half].assign(static_cast<std::size_t>(unknowns(half) + bandwidth_), 0.0);
  }
  std::copy_n(x.begin(), unknowns(0), part[0].begin());
  std::copy_n(x.rbegin(), ends_[1], part[1].begin());
  const double operations = 2.0 * size_ * bandwidth_;
  for_halves(operations, [&](std::size_t half) { band_[half].substitute(0, ends_[half], part[half].data()); });
  double* const middle = part[0].data() + ends_[0];
  double* const copy = part[1].data() + ends_[1];  // of the middle, from its end
  for (int a = 0; halves && a < middle_; ++a) middle[a] += copy[middle_ - 1 - a];
  band_[0].substitute(ends_[0], unknowns(0), part[0].data());
  std::fill_n(middle + middle_, bandwidth_, 0.0);
  band_[0].substitute_back(ends_[0], unknowns(0), part[0].data());
  if (halves) std::reverse_copy(middle, middle + middle_, copy);
  for_halves(operations, [&](std::size_t half) { band_[half].substitute_back(0, ends_[half], part[half].data()); });
  std::copy_n(part[0].begin(), unknowns(0), x.begin());
  std::copy_n(part[1].begin(), ends_[1], x.rbegin());
}

template class BandOrder<2>;
template class BandOrder<3>;

}  // namespace quicksand
