#include "solvers/banded_cholesky.hpp"

#include <array>
#include <cmath>
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

/// Columns that are eliminated together, and as many that these update in one pass over the rows.
constexpr int panel = 4;
/// A band has two halves where it is so many times as long as wide.
constexpr int least_slenderness = 8;
/// Operations that count as a point of a simple loop. Halves are worth a second thread when they take some hundred
/// microseconds, because much that is serial comes between them.
constexpr double operations_per_point = 50;

/// First row of the pack that a row lies in.
int pack_of(int row) { return row / pack_width * pack_width; }

/// `x` where the rows of its pack are `first` or more, else `before`.
Pack from_row(int first, int row, const Pack& x, const Pack& before) {
  Pack number;
  for (int l = 0; l < pack_width; ++l) number[l] = l;
  return number >= static_cast<double>(first - row) ? x : before;
}

/// A pack of rows of every column of a panel.
struct PanelRows {
  Pack of_column[panel];

  PanelRows(const double* const (&column)[panel], int row) {
    for (int m = 0; m < panel; ++m) of_column[m] = load_pack(column[m] + row);
  }
};

/// x - factor . rows
Pack without(Pack x, const double (&factor)[panel], const PanelRows& rows) {
  for (int m = 0; m < panel; ++m) x = minus_product(x, factor[m], rows.of_column[m]);
  return x;
}

}  // namespace

int BandedCholesky::numbers_per_unknown(int bandwidth) {
  // Beyond the band a column has zeros for the rows of its panel's last pack, and for those of the last factors.
  constexpr int last_pack = panel + pack_width - 2;
  constexpr int last_factors = 2 * (panel - 1);
  return pack_of(bandwidth + std::max(last_pack, last_factors) + pack_width - 1) + 1;
}

BandedCholesky::Band::Band(int size, int bandwidth)
    : bandwidth_(bandwidth),
      stride_(numbers_per_unknown(bandwidth) - 1),
      values_(static_cast<std::size_t>((size + excess(bandwidth) + 1) * (stride_ + 1) / pack_width + 1)) {}

void BandedCholesky::Band::clear_from(int first) {
  double* const end = reinterpret_cast<double*>(values_.data() + values_.size());
  std::fill(column(first) + first, end, 0.0);
}

int BandedCholesky::Band::excess(int bandwidth) { return bandwidth + panel + pack_width; }

/// Eliminates the columns of a panel from each other. \param inverse  is set to those of the pivots
bool BandedCholesky::Band::eliminate_panel(int first, int count, double* inverse) {
  const int end = first + count + bandwidth_;
  for (int j = first; j < first + count; ++j) {
    double* const own = column(j);
    double factor[panel];
    for (int l = first; l < j; ++l) factor[l - first] = column(l)[j] * inverse[l - first];
    for (int row = j; row < end; row += pack_width) {
      Pack x = load_pack(own + row);
      for (int l = first; l < j; ++l) x = minus_product(x, factor[l - first], load_pack(column(l) + row));
      store_pack(x, own + row);
    }
    if (!(own[j] > 0) || !std::isfinite(own[j])) return false;
    inverse[j - first] = 1 / own[j];
  }
  return true;
}

bool BandedCholesky::Band::eliminate(int first, int last) {
  for (int j = first; j < last; j += panel) {
    const int count = std::min(panel, last - j);
    double inverse[panel] = {};  // 0 for columns that are not of the panel, which so have no effect
    if (!eliminate_panel(j, count, inverse)) return false;
    const double* const source[panel] = {column(j), column(j + 1), column(j + 2), column(j + 3)};
    const int end = j + count + bandwidth_;
    for (int k = j + count; k < end; k += panel) {
      double* const target[panel] = {column(k), column(k + 1), column(k + 2), column(k + 3)};
      double factor[panel][panel];
      bool couples = false;
      for (int q = 0; q < panel; ++q) {
        for (int m = 0; m < panel; ++m) {
          factor[q][m] = source[m][k + q] * inverse[m];
          couples = couples || factor[q][m] != 0;
        }
      }
      if (!couples) continue;
      int row = pack_of(k);
      for (; row < k + panel - 1; row += pack_width) {  // some of the targets begin further down
        const PanelRows rows(source, row);
        for (int q = 0; q < panel; ++q) {
          const Pack x = load_pack(target[q] + row);
          store_pack(from_row(k + q, row, without(x, factor[q], rows), x), target[q] + row);
        }
      }
      for (; row < end; row += pack_width) {
        const PanelRows rows(source, row);
        for (int q = 0; q < panel; ++q) {
          store_pack(without(load_pack(target[q] + row), factor[q], rows), target[q] + row);
        }
      }
    }
    for (int m = 0; m < count; ++m) {
      double* const own = column(j + m);
      for (int row = j + m + 1; row < end; row += pack_width) store_pack(load_pack(own + row) * inverse[m], own + row);
      own[j + m] = inverse[m];
    }
  }
  return true;
}

void BandedCholesky::Band::substitute(int first, int last, double* x) const {
  for (int j = first; j < last; j += panel) {
    const int count = std::min(panel, last - j);
    const double* const source[panel] = {column(j), column(j + 1), column(j + 2), column(j + 3)};
    double factor[panel] = {};
    for (int m = 0; m < count; ++m) {
      factor[m] = x[j + m];
      for (int l = 0; l < m; ++l) factor[m] -= source[l][j + m] * factor[l];
      x[j + m] = factor[m];
    }
    for (int row = j + count; row < j + count + bandwidth_; row += pack_width) {
      store_pack(without(load_pack(x + row), factor, PanelRows(source, row)), x + row);
    }
  }
}

void BandedCholesky::Band::substitute_back(int first, int last, double* x) const {
  for (int end = last, count; end > first; end -= count) {
    count = std::min(panel, end - first);
    const int j = end - count;
    const double* const source[panel] = {column(j), column(j + 1), column(j + 2), column(j + 3)};
    Pack sum[panel] = {};
    for (int row = end; row < end + bandwidth_; row += pack_width) {
      const Pack known = load_pack(x + row);
      for (int m = 0; m < panel; ++m) sum[m] += load_pack(source[m] + row) * known;
    }
    for (int m = count - 1; m >= 0; --m) {
      double value = x[j + m] * source[m][j + m];
      for (int l = 0; l < pack_width; ++l) value -= sum[m][l];
      for (int l = m + 1; l < count; ++l) value -= source[m][j + l] * x[j + l];
      x[j + m] = value;
    }
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
  band_[0].clear_from(ends_[0] + middle_);
  if (halves) band_[1].clear_from(ends_[1]);
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
    part[half].assign(static_cast<std::size_t>(unknowns(half)) + static_cast<std::size_t>(Band::excess(bandwidth_)),
                      0.0);
  }
  std::copy_n(x.begin(), unknowns(0), part[0].begin());
  std::copy_n(x.rbegin(), ends_[1], part[1].begin());
  const double operations = 2.0 * size_ * bandwidth_;
  for_halves(operations, [&](std::size_t half) { band_[half].substitute(0, ends_[half], part[half].data()); });
  double* const middle = part[0].data() + ends_[0];
  double* const copy = part[1].data() + ends_[1];  // of the middle, from its end
  for (int a = 0; halves && a < middle_; ++a) middle[a] += copy[middle_ - 1 - a];
  band_[0].substitute(ends_[0], unknowns(0), part[0].data());
  band_[0].substitute_back(ends_[0], unknowns(0), part[0].data());
  if (halves) std::reverse_copy(middle, middle + middle_, copy);
  for_halves(operations, [&](std::size_t half) { band_[half].substitute_back(0, ends_[half], part[half].data()); });
  std::copy_n(part[0].begin(), unknowns(0), x.begin());
  std::copy_n(part[1].begin(), ends_[1], x.rbegin());
}

template class BandOrder<2>;
template class BandOrder<3>;

}  // namespace quicksand
