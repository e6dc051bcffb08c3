#include "physics/pressure_operator.hpp"

#include <algorithm>

namespace quicksand {

namespace {

/// Nodes of a row that are worked on at once: their buffers stay in the nearest cache.
constexpr int chunk = 128;

/// Integral of grad N_a . grad N_b over a cell.
template <int Dim>
double even_stiffness(const Grid<Dim>& grid, const Index<Dim>& i, int a, int b) {
  using C = Corners<Dim>;
  double total = 0;
  for (int d = 0; d < Dim; ++d) {
    double product = (C::bit(a, d) == C::bit(b, d) ? 1 : -1) * grid.line_element(d, i[d]).stiffness;
    for (int e = 0; e < Dim; ++e) {
      if (e != d) product *= grid.line_element(e, i[e]).mass[C::bit(a, e)][C::bit(b, e)];
    }
    total += product;
  }
  return total;
}

constexpr std::size_t in_lower_half(int a, int b) {
  const int row = std::max(a, b);
  const int place = row * (row + 1) / 2 + std::min(a, b);
  return static_cast<std::size_t>(place);
}

}  // namespace

template <int Dim>
CellPressure<Dim>::CellPressure(const Grid<Dim>& grid, const Corners<Dim>& corners,
                                const PressureElements<Dim>& elements, Cell c, const Index<Dim>& i)
    : volume(grid.volume(i)), mean(elements.gradient(grid, corners, c, i)) {
  for (int a = 0; a < Corners<Dim>::count; ++a) {
    for (int b = 0; b <= a; ++b) stiffness[a][b] = stiffness[b][a] = even_stiffness(grid, i, a, b);
  }
  if (!elements.cut[c]) return;
  const MeanGradient<Dim> even = even_gradient(grid, i);
  for (int a = 0; a < Corners<Dim>::count; ++a) {
    for (int b = 0; b < Corners<Dim>::count; ++b) {
      stiffness[a][b] += volume * (product(mean, a, b) - product(even, a, b));
    }
  }
}

/// What a row of nodes has to do with the rows of nodes around a row of cells next to it. A row of nodes or cells is
/// known by the bits of its place across x, one for each axis but that.
template <int Dim>
struct PressureOperator<Dim>::RowFactors {
  static constexpr int count = 1 << (Dim - 1);
  Step row[count];          ///< from the nodes' own row to each
  double mass[count];       ///< product of mass factors across x
  double stiffness[count];  ///< sum over the axes across x of stiffness along one and mass along the other

  /// \param node        first node of the row
  /// \param transverse  which corner row of the cells the nodes are
  RowFactors(const Grid<Dim>& grid, const Index<Dim>& node, int transverse) {
    for (int other = 0; other < count; ++other) {
      row[other] = {};
      mass[other] = 1;
      stiffness[other] = 0;
      for (int e = 1; e < Dim; ++e) {
        const int own_bit = (transverse >> (e - 1)) & 1;
        const int other_bit = (other >> (e - 1)) & 1;
        const LineElement& element = grid.line_element(e, node[e] - own_bit);
        row[other] = row[other] + (other_bit - own_bit) * grid.step(e);
        const double m = element.mass[own_bit][other_bit];
        const double k = own_bit == other_bit ? element.stiffness : -element.stiffness;
        stiffness[other] = stiffness[other] * m + mass[other] * k;
        mass[other] *= m;
      }
    }
  }
};

template <int Dim>
PressureOperator<Dim>::PressureOperator(const Domain<Dim>& domain, const CellField& rho,
                                        const PressureElements<Dim>& elements, double dt, const Box<Dim>& box)
    : domain_(domain), elements_(elements), box_(box), scale_(domain.layout()) {
  const Grid<Dim>& grid = domain.grid;
  const Layout<Dim>& layout = domain.layout();
  for (int i = -ghosts; i < grid.owned_cells()[0] + ghosts; ++i) {
    const LineElement& element = grid.line_element(0, i);
    along_x_.stiffness.push_back(element.stiffness);
    along_x_.mass_low.push_back(element.mass[0][0]);
    along_x_.mass_across.push_back(element.mass[0][1]);
    along_x_.mass_high.push_back(element.mass[1][1]);
  }
  for_each<Cell>(layout, grid.cells(),
                 [&](Cell c) { scale_[c] = elements.bears[c] && !elements.cut[c] ? dt / rho[c] : 0.0; });
  find_cut_cells(rho, dt);
}

template <int Dim>
void PressureOperator<Dim>::find_cut_cells(const CellField& rho, double dt) {
  const Grid<Dim>& grid = domain_.grid;
  const Layout<Dim>& layout = domain_.layout();
  const std::ptrdiff_t row_length = layout.step(1).n;
  first_cut_.assign(static_cast<std::size_t>(layout.size() / row_length) + 1, 0);
  const Rows<Dim> rows(layout, grid.cells());
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    const std::ptrdiff_t start = rows.start(r);
    for (int i = 0; i < rows.length; ++i) {
      const Cell c{start + i};
      if (elements_.bears[c] && elements_.cut[c]) cut_cells_.push_back(c);
    }
    first_cut_[static_cast<std::size_t>(start / row_length) + 1] = cut_cells_.size();
  }
  // Rows of ghost cells have none: they begin where the row before them ends.
  for (std::size_t row = 1; row < first_cut_.size(); ++row) {
    first_cut_[row] = std::max(first_cut_[row], first_cut_[row - 1]);
  }
  cut_matrices_.resize(cut_cells_.size());
  const Corners<Dim> corner(layout);
  const auto count = static_cast<std::ptrdiff_t>(cut_cells_.size());
  for_each_number(count, count * corners * corners, [&](std::ptrdiff_t k) {
    const auto at = static_cast<std::size_t>(k);
    const Cell c = cut_cells_[at];
    const CellPressure<Dim> cell(grid, corner, elements_, c, layout.multi(c.n));
    for (int a = 0; a < corners; ++a) {
      for (int b = 0; b <= a; ++b) cut_matrices_[at][in_lower_half(a, b)] = dt / rho[c] * cell.stiffness[a][b];
    }
  });
}

template <int Dim>
void PressureOperator<Dim>::add_even_cells(const NodeField& x, const RowFactors& factors, std::ptrdiff_t start,
                                           int first, int length, double* y) const {
  // Sums across x, of the nodes and of one on either side of them.
  double mass[chunk + 2];
  double stiffness[chunk + 2];
  const double* row[RowFactors::count];
  for (int k = 0; k < RowFactors::count; ++k) row[k] = &x[Node{start - 1} + factors.row[k]];
  for_each_side_by_side(length + 2, [&](int i) {
    double m = 0;
    double s = 0;
    for (int k = 0; k < RowFactors::count; ++k) {
      m += factors.mass[k] * row[k][i];
      s += factors.stiffness[k] * row[k][i];
    }
    mass[i] = m;
    stiffness[i] = s;
  });
  // From here on element i lies below node i, element i + 1 above it.
  const double* const scale = &scale_[Cell{start - 1} + factors.row[0]];
  const int below_first = first - 1 + ghosts;
  const auto element = static_cast<std::size_t>(below_first);
  const double* const k_x = &along_x_.stiffness[element];
  const double* const m_low = &along_x_.mass_low[element];
  const double* const m_across = &along_x_.mass_across[element];
  const double* const m_high = &along_x_.mass_high[element];
  for_each_side_by_side(length, [&](int i) {
    const double below = k_x[i] * (mass[i + 1] - mass[i]) + m_across[i] * stiffness[i] + m_high[i] * stiffness[i + 1];
    const double above =
        k_x[i + 1] * (mass[i + 1] - mass[i + 2]) + m_low[i + 1] * stiffness[i + 1] + m_across[i + 1] * stiffness[i + 2];
    y[i] += scale[i] * below + scale[i + 1] * above;
  });
}

template <int Dim>
void PressureOperator<Dim>::add_cut_cells(const NodeField& x, int transverse, Cell first_cell, int length,
                                          double* y) const {
  const Corners<Dim> corner(domain_.layout());
  const auto row = static_cast<std::size_t>(first_cell.n / domain_.layout().step(1).n);
  for (std::size_t k = first_cut_[row]; k < first_cut_[row + 1]; ++k) {
    const Cell c = cut_cells_[k];
    const std::ptrdiff_t low = c.n - first_cell.n;
    for (int high = 0; high < 2; ++high) {
      if (low + high < 0 || low + high >= length) continue;
      const int a = 2 * transverse + high;
      double sum = 0;
      for (int b = 0; b < corners; ++b) sum += cut_matrices_[k][in_lower_half(a, b)] * x[low_node(c) + corner.step[b]];
      y[low + high] += sum;
    }
  }
}

template <int Dim>
void PressureOperator<Dim>::apply(const NodeField& x, NodeField& y) const {
  constexpr int cost = 1 << (2 * Dim);
  const Layout<Dim>& layout = domain_.layout();
  const Rows<Dim> rows(layout, box_);
  rows.for_each(
      [&](std::ptrdiff_t start) {
        double* const row = &y[Node{start}];
        std::fill_n(row, rows.length, 0.0);
        const Index<Dim> node = layout.multi(start);
        for (int transverse = 0; transverse < RowFactors::count; ++transverse) {
          const RowFactors factors(domain_.grid, node, transverse);
          for (int i = 0; i < rows.length; i += chunk) {
            add_even_cells(x, factors, start + i, node[0] + i, std::min(chunk, rows.length - i), row + i);
          }
          add_cut_cells(x, transverse, Cell{start} + factors.row[0], rows.length, row);
        }
        const unsigned char* const free = &elements_.free[Node{start}];
        for (int i = 0; i < rows.length; ++i) row[i] = free[i] ? row[i] : 0.0;
      },
      cost);
}

template struct CellPressure<2>;
template struct CellPressure<3>;
template class PressureOperator<2>;
template class PressureOperator<3>;

}  // namespace quicksand
