#include "physics/projection.hpp"

#include <algorithm>
#include <limits>

namespace quicksand {

namespace {

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
void assemble(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellField& rho,
              const PressureElements<Dim>& elements, double dt, const NodeField& increment, ProjectionWork<Dim>& work) {
  using C = Corners<Dim>;
  const Grid<Dim>& grid = domain.grid;
  const C corners(domain.layout());
  const PairTable<Dim> pairs(work.matrix);
  const NodeMask& free = elements.free;
  for_each<Node>(domain.layout(), work.matrix.box, [&](Node n) {
    work.matrix.diagonal[n] = free[n] ? 0.0 : 1.0;
    for (auto& lower : work.matrix.lower) lower[n] = 0;
    work.rhs[n] = 0;
  });
  Box<Dim> cells = work.matrix.box;
  for (int d = 0; d < Dim; ++d) --cells.lo[d];
  for_each_coloured<Cell>(domain.layout(), intersect(cells, grid.cells()), [&](Cell c, const Index<Dim>& i) {
    if (!elements.bears[c]) return;
    const double scale = dt / rho[c];
    const double volume = grid.volume(c);
    const MeanGradient<Dim> g = elements.gradient(grid, corners, c, i);
    const MeanGradient<Dim> even = even_gradient(grid, i);
    const Node origin = low_node(c);
    for (int a = 0; a < C::count; ++a) {
      const Node na = origin + corners.step[a];
      if (!free[na]) continue;
      double source = 0;
      for (int d = 0; d < Dim; ++d) source += volume * u[d][c] * g.at[a][d];
      for (int b = 0; b < C::count; ++b) {
        const Node nb = origin + corners.step[b];
        // The levers change the mean gradient; what the stiffness holds beyond it stays.
        double k = stiffness(grid, i, a, b);
        for (int d = 0; d < Dim; ++d) k += volume * (g.at[a][d] * g.at[b][d] - even.at[a][d] * even.at[b][d]);
        k *= scale;
        if (a == b) work.matrix.diagonal[na] += k;
        if (a > b && free[nb]) work.matrix.lower[pairs.offset[a][b]][na] += k;
        if (!free[nb]) source -= k * increment[nb];
      }
      work.rhs[na] += source;
    }
  });
}

/// What comes in through inflow sides: -integral of N u . n over them, on the right-hand side.
template <int Dim>
void add_inflow(const Domain<Dim>& domain, const PressureElements<Dim>& elements, ProjectionWork<Dim>& work) {
  using C = Corners<Dim>;
  const Grid<Dim>& grid = domain.grid;
  const C corners(domain.layout());
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (domain.sides.at(d, s).kind != SideKind::inflow) continue;
      for_each_coloured<Face>(domain.layout(), intersect(domain.side_faces(d, s), grid.faces(d)),
                              [&](Face f, const Index<Dim>& i) {
                                const Cell inner = s == 0 ? high_cell(f) : high_cell(f) - grid.step(d);
                                if (!elements.bears[inner]) return;
                                const double u = domain.side_velocities.at(d, s, grid.centre(i))[d];
                                const double inwards = (s == 0 ? u : -u) * grid.area(d, f);
                                for (int k = 0; k < C::count; ++k) {
                                  if (C::bit(k, d) == 1) continue;
                                  double part = inwards;
                                  for (int e = 0; e < Dim; ++e) {
                                    if (e != d) part *= grid.line_element(e, i[e]).fraction[C::bit(k, e)];
                                  }
                                  const Node n = Node{f.n} + corners.step[k];
                                  if (elements.free[n]) work.rhs[n] += part;
                                }
                              });
    }
  }
}

}  // namespace

template <int Dim>
void set_open_pressures(const Domain<Dim>& domain, NodeField& outer_pressure) {
  const Box<Dim> nodes = domain.grid.nodes();
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      const Side& side = domain.sides.at(d, s);
      if (!is_open(side) || !domain.grid.at_boundary(d, s)) continue;
      Box<Dim> layer = nodes;
      (s == 0 ? layer.hi[d] : layer.lo[d]) = s == 0 ? 1 : nodes.hi[d] - 1;
      for_each<Node>(domain.layout(), layer, [&](Node n) { outer_pressure[n] = side.pressure; });
    }
  }
}

template <int Dim>
void add_pressure_gradient(const Domain<Dim>& domain, const NodeField& pressure, const CellField& rho,
                           const PressureElements<Dim>& elements, double factor_dt, CellVectors<Dim>& u) {
  const Corners<Dim> corners(domain.layout());
  for_each_indexed<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<Dim>& i) {
    if (!elements.bears[c]) return;
    const MeanGradient<Dim> g = elements.gradient(domain.grid, corners, c, i);
    for (int d = 0; d < Dim; ++d) {
      double gradient = 0;
      for (int k = 0; k < Corners<Dim>::count; ++k) {
        gradient += g.at[k][d] * pressure[low_node(c) + corners.step[k]];
      }
      u[d][c] += factor_dt / rho[c] * gradient;
    }
  });
}

template <int Dim>
SolveReport solve_pressure(const Domain<Dim>& domain, Projected what, const CellVectors<Dim>& u_bar_star,
                           const CellField& rho, const PressureElements<Dim>& elements, const NodeField& outer_pressure,
                           double dt, const SolveOptions& options, ProjectionWork<Dim>& work, NodeField& pressure) {
  const Box<Dim> nodes = domain.grid.nodes();
  const double reference = least_given(domain, elements.free, outer_pressure);
  for_each<Node>(domain.layout(), nodes, [&](Node n) {
    if (!elements.free[n]) pressure[n] = outer_pressure[n];
    work.increment[n] = pressure[n] - reference;
  });
  work.matrix.box = bounding_box<Node>(domain.layout(), nodes, [&](Node n) { return elements.free[n] != 0; });
  if (work.matrix.box.empty()) return {.converged = true};
  assemble(domain, u_bar_star, rho, elements, dt, work.increment, work);
  if (what == Projected::velocity) add_inflow(domain, elements, work);
  const SolveReport report = solve(work.matrix, work.rhs, work.increment, options);
  require_converged(report, "pressure projection");
  for_each<Node>(domain.layout(), work.matrix.box, [&](Node n) {
    if (elements.free[n]) pressure[n] = reference + work.increment[n];
  });
  return report;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                                 \
  template void add_pressure_gradient(const Domain<Dim>&, const NodeField&, const CellField&,                      \
                                      const PressureElements<Dim>&, double, CellVectors<Dim>&);                    \
  template void set_open_pressures(const Domain<Dim>&, NodeField&);                                                \
  template SolveReport solve_pressure(const Domain<Dim>&, Projected, const CellVectors<Dim>&, const CellField&,    \
                                      const PressureElements<Dim>&, const NodeField&, double, const SolveOptions&, \
                                      ProjectionWork<Dim>&, NodeField&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
