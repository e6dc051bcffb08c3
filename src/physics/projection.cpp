#include "physics/projection.hpp"

#include <algorithm>
#include <limits>

namespace quicksand {

namespace {

/// The 2^Dim corners of a cell: corner k lies on the high side of axis d if bit d of k is set.
template <int Dim>
struct Corners {
  static constexpr int count = 1 << Dim;
  Step step[count];

  explicit Corners(const Layout<Dim>& layout) {
    for (int k = 0; k < count; ++k) {
      step[k] = {};
      for (int d = 0; d < Dim; ++d) {
        if (bit(k, d)) step[k] = step[k] + layout.step(d);
      }
    }
  }
  static constexpr int bit(int k, int d) { return (k >> d) & 1; }
};

/// Element mean of dN_k/dx_d in a cell for all corners k.
template <int Dim>
double mean_gradient(const Grid<Dim>& grid, const Index<Dim>& i, int k, int d) {
  double g = (Corners<Dim>::bit(k, d) ? 1 : -1) / grid.width_1d(d, i[d]);
  for (int e = 0; e < Dim; ++e) {
    if (e != d) g *= grid.line_element(e, i[e]).fraction[Corners<Dim>::bit(k, e)];
  }
  return g;
}

/// Integral of grad N_a . grad N_b over a cell.
template <int Dim>
double stiffness(const Grid<Dim>& grid, const Index<Dim>& i, int a, int b) {
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

/// Which lower offset of the box stencil leads from the higher to the lower of two corners.
template <int Dim>
struct PairTable {
  std::size_t offset[1 << Dim][1 << Dim] = {};  ///< [a][b] for a > b

  explicit PairTable(const StencilMatrix<Dim, Node>& matrix) {
    using C = Corners<Dim>;
    for (int a = 0; a < C::count; ++a) {
      for (int b = 0; b < a; ++b) {
        Index<Dim> between;
        for (int d = 0; d < Dim; ++d) between[d] = C::bit(b, d) - C::bit(a, d);
        const auto found = std::find(matrix.offsets.begin(), matrix.offsets.end(), between);
        offset[a][b] = static_cast<std::size_t>(found - matrix.offsets.begin());
      }
    }
  }
};

/// A node is solved for if all cells around it, in the domain or mirrored, are liquid.
template <int Dim>
void mark_free_nodes(const Domain<Dim>& domain, const CellMask& liquid, NodeMask& free) {
  const Corners<Dim> corners(domain.layout());
  for_each<Node>(domain.layout(), domain.grid.nodes(), [&](Node n) {
    bool all = true;
    for (int k = 0; k < Corners<Dim>::count; ++k) all = all && liquid[high_cell(n) - corners.step[k]];
    free[n] = all ? 1 : 0;
  });
}

/// The least pressure given at a node, 0 if there is none. The solver's relative tolerance is to mean differences of
/// pressure, not their height above zero.
template <int Dim>
double least_given(const Domain<Dim>& domain, const NodeMask& free, const NodeField& outer_pressure) {
  constexpr double none = std::numeric_limits<double>::lowest();
  const double negative = maximum<Node>(domain.layout(), domain.grid.nodes(), none,
                                        [&](Node n) { return free[n] ? none : -outer_pressure[n]; });
  return negative > none ? -negative : 0.0;
}

/// Matrix dt K on the free nodes, and the right-hand side sum V u-bar* . grad N less what the given nodes contribute.
template <int Dim>
void assemble(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellField& rho, const CellMask& liquid,
              double dt, const NodeField& increment, ProjectionWork<Dim>& work) {
  using C = Corners<Dim>;
  const Grid<Dim>& grid = domain.grid;
  const C corners(domain.layout());
  const PairTable<Dim> pairs(work.matrix);
  const NodeMask& free = work.free;
  for_each<Node>(domain.layout(), work.matrix.box, [&](Node n) {
    work.matrix.diagonal[n] = free[n] ? 0.0 : 1.0;
    for (auto& lower : work.matrix.lower) lower[n] = 0;
    work.rhs[n] = 0;
  });
  Box<Dim> cells = work.matrix.box;
  for (int d = 0; d < Dim; ++d) --cells.lo[d];
  for_each_coloured<Cell>(domain.layout(), intersect(cells, grid.cells()), [&](Cell c, const Index<Dim>& i) {
    if (!liquid[c]) return;
    const double scale = dt / rho[c];
    const Node origin = low_node(c);
    for (int a = 0; a < C::count; ++a) {
      const Node na = origin + corners.step[a];
      if (!free[na]) continue;
      double source = 0;
      for (int d = 0; d < Dim; ++d) source += grid.volume(c) * u[d][c] * mean_gradient(grid, i, a, d);
      for (int b = 0; b < C::count; ++b) {
        const Node nb = origin + corners.step[b];
        const double k = scale * stiffness(grid, i, a, b);
        if (a == b) work.matrix.diagonal[na] += k;
        if (a > b && free[nb]) work.matrix.lower[pairs.offset[a][b]][na] += k;
        if (!free[nb]) source -= k * increment[nb];
      }
      work.rhs[na] += source;
    }
  });
}

}  // namespace

template <int Dim>
void add_pressure_gradient(const Domain<Dim>& domain, const NodeField& pressure, const CellField& rho,
                           const CellMask& liquid, double factor_dt, CellVectors<Dim>& u) {
  const Corners<Dim> corners(domain.layout());
  for_each_indexed<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<Dim>& i) {
    if (!liquid[c]) return;
    for (int d = 0; d < Dim; ++d) {
      double gradient = 0;
      for (int k = 0; k < Corners<Dim>::count; ++k) {
        gradient += mean_gradient(domain.grid, i, k, d) * pressure[low_node(c) + corners.step[k]];
      }
      u[d][c] += factor_dt / rho[c] * gradient;
    }
  });
}

template <int Dim>
void apply_outer_pressure(const Domain<Dim>& domain, const CellMask& liquid, const NodeField& outer_pressure,
                          ProjectionWork<Dim>& work, NodeField& pressure) {
  mark_free_nodes(domain, liquid, work.free);
  for_each<Node>(domain.layout(), domain.grid.nodes(), [&](Node n) {
    if (!work.free[n]) pressure[n] = outer_pressure[n];
  });
}

template <int Dim>
SolveReport solve_pressure(const Domain<Dim>& domain, const CellVectors<Dim>& u_bar_star, const CellField& rho,
                           const CellMask& liquid, const NodeField& outer_pressure, double dt,
                           const SolveOptions& options, ProjectionWork<Dim>& work, NodeField& pressure) {
  const Box<Dim> nodes = domain.grid.nodes();
  mark_free_nodes(domain, liquid, work.free);
  const double reference = least_given(domain, work.free, outer_pressure);
  for_each<Node>(domain.layout(), nodes, [&](Node n) {
    if (!work.free[n]) pressure[n] = outer_pressure[n];
    work.increment[n] = pressure[n] - reference;
  });
  work.matrix.box = bounding_box<Node>(domain.layout(), nodes, [&](Node n) { return work.free[n] != 0; });
  if (work.matrix.box.empty()) return {.converged = true};
  assemble(domain, u_bar_star, rho, liquid, dt, work.increment, work);
  const SolveReport report = solve(work.matrix, work.rhs, work.increment, options);
  require_converged(report, "pressure projection");
  for_each<Node>(domain.layout(), work.matrix.box, [&](Node n) {
    if (work.free[n]) pressure[n] = reference + work.increment[n];
  });
  return report;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                                     \
  template void add_pressure_gradient(const Domain<Dim>&, const NodeField&, const CellField&, const CellMask&, double, \
                                      CellVectors<Dim>&);                                                              \
  template void apply_outer_pressure(const Domain<Dim>&, const CellMask&, const NodeField&, ProjectionWork<Dim>&,      \
                                     NodeField&);                                                                      \
  template SolveReport solve_pressure(const Domain<Dim>&, const CellVectors<Dim>&, const CellField&, const CellMask&,  \
                                      const NodeField&, double, const SolveOptions&, ProjectionWork<Dim>&,             \
                                      NodeField&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
