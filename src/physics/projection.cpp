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

/// What pressures at the corners of a cell do in it.
template <int Dim>
struct CellPressure {
  double volume;
  MeanGradient<Dim> mean;                ///< levers and all
  double stiffness[1 << Dim][1 << Dim];  ///< integral of grad N_a . grad N_b, its part of mean gradients that of `mean`

  CellPressure(const Grid<Dim>& grid, const Corners<Dim>& corners, const PressureElements<Dim>& elements, Cell c,
               const Index<Dim>& i)
      : volume(grid.volume(i)), mean(elements.gradient(grid, corners, c, i)) {
    for (int a = 0; a < Corners<Dim>::count; ++a) {
      for (int b = 0; b <= a; ++b) stiffness[a][b] = stiffness[b][a] = quicksand::stiffness(grid, i, a, b);
    }
    if (!elements.cut[c]) return;
    const MeanGradient<Dim> even = even_gradient(grid, i);
    for (int a = 0; a < Corners<Dim>::count; ++a) {
      for (int b = 0; b < Corners<Dim>::count; ++b) {
        stiffness[a][b] += volume * (product(mean, a, b) - product(even, a, b));
      }
    }
  }
  /// Part of the stiffness that is not of mean gradients.
  double surplus(int a, int b) const { return stiffness[a][b] - volume * product(mean, a, b); }

 private:
  static double product(const MeanGradient<Dim>& g, int a, int b) {
    double sum = 0;
    for (int d = 0; d < Dim; ++d) sum += g.at[a][d] * g.at[b][d];
    return sum;
  }
};

/// Matrix dt K on the free nodes, and the right-hand side: sum V u-bar* . grad N, the remembered surplus of the
/// stiffness on the last pressure, less what the given nodes contribute.
/// \param increment  the last pressure on free nodes, the given one on others
template <int Dim>
void assemble(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellField& rho,
              const PressureElements<Dim>& elements, double dt, double memory, const NodeField& increment,
              StencilMatrix<Dim, Node>& matrix, NodeField& rhs) {
  using C = Corners<Dim>;
  const Grid<Dim>& grid = domain.grid;
  const Layout<Dim>& layout = domain.layout();
  const C corners(layout);
  const PairTable<Dim> pairs(matrix);
  const NodeMask& free = elements.free;
  // One layer more: rows reach couplings of the nodes around the box, which may be left from another box.
  for_each<Node>(layout, grow(matrix.box, 1), [&](Node n) {
    matrix.diagonal[n] = free[n] ? 0.0 : 1.0;
    for (auto& lower : matrix.lower) lower[n] = 0;
    rhs[n] = 0;
  });
  Box<Dim> cells = matrix.box;
  for (int d = 0; d < Dim; ++d) --cells.lo[d];
  for_each_coloured<Cell>(layout, intersect(cells, grid.cells()), [&](Cell c, const Index<Dim>& i) {
    if (!elements.bears[c]) return;
    const double scale = dt / rho[c];
    const CellPressure<Dim> cell(grid, corners, elements, c, i);
    Node corner[C::count];
    for (int k = 0; k < C::count; ++k) corner[k] = C::of_cell(layout, c, i, k);
    for (int a = 0; a < C::count; ++a) {
      const Node na = corner[a];
      if (!free[na]) continue;
      double source = 0;
      for (int d = 0; d < Dim; ++d) source += cell.volume * u[d][c] * cell.mean.at[a][d];
      for (int b = 0; b < C::count; ++b) {
        const Node nb = corner[b];
        const double k = scale * cell.stiffness[a][b];
        if (a == b) matrix.diagonal[na] += k;
        if (a > b && free[nb]) matrix.lower[pairs.offset[a][b]][na] += k;
        if (!free[nb]) source -= k * increment[nb];
        if (memory > 0) source += memory * scale * cell.surplus(a, b) * increment[nb];
      }
      rhs[na] += source;
    }
  });
  matrix.wrap_couplings();
}

/// What comes in through inflow sides: -integral of N u . n over them, on the right-hand side.
template <int Dim>
void add_inflow(const Domain<Dim>& domain, const PressureElements<Dim>& elements, ProjectionWork<Dim>& work) {
  using C = Corners<Dim>;
  const Grid<Dim>& grid = domain.grid;
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (domain.sides.at(d, s).kind != SideKind::inflow) continue;
      for_each_coloured<Face>(domain.layout(), intersect(domain.side_faces(d, s), grid.faces(d)),
                              [&](Face f, const Index<Dim>& i) {
                                const Cell inner = s == 0 ? high_cell(f) : high_cell(f) - grid.step(d);
                                if (!elements.bears[inner]) return;
                                const double u = domain.side_velocities.at(d, s, grid.centre(i))[d];
                                const double inwards = (s == 0 ? u : -u) * grid.area(d, i);
                                for (int k = 0; k < C::count; ++k) {
                                  if (C::bit(k, d) == 1) continue;
                                  double part = inwards;
                                  for (int e = 0; e < Dim; ++e) {
                                    if (e != d) part *= grid.line_element(e, i[e]).fraction[C::bit(k, e)];
                                  }
                                  const Node n = C::of_cell(domain.layout(), high_cell(f), i, k);
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
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c, const Index<Dim>& i) {
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
SolveReport solve_pressure(const Domain<Dim>& domain, Projected what, double memory, const CellVectors<Dim>& u_bar_star,
                           const CellField& rho, const PressureElements<Dim>& elements, const NodeField& outer_pressure,
                           double dt, const SolveOptions& options, ProjectionWork<Dim>& work, NodeField& pressure) {
  const Box<Dim> nodes = domain.grid.nodes();
  const double reference = least_given(domain, elements.free, outer_pressure);
  for_each<Node>(domain.layout(), nodes, [&](Node n) {
    if (!elements.free[n]) pressure[n] = outer_pressure[n];
    work.increment[n] = pressure[n] - reference;
  });
  const Box<Dim> box = bounding_box<Node>(domain.layout(), nodes, [&](Node n) { return elements.free[n] != 0; });
  SolveReport report{.converged = true};
  if (!box.empty()) {
    StencilMatrix<Dim, Node> matrix(domain.layout(), Stencil::box);
    matrix.box = box;
    assemble(domain, u_bar_star, rho, elements, dt, memory, work.increment, matrix, work.rhs);
    if (what == Projected::velocity) add_inflow(domain, elements, work);
    report = solve(matrix, work.rhs, work.increment, options);
    require_converged(report, "pressure projection");
    for_each<Node>(domain.layout(), box, [&](Node n) {
      if (elements.free[n]) pressure[n] = reference + work.increment[n];
      work.increment[n] = pressure[n] - reference;  // the solve leaves 0 on given nodes
    });
  }
  wrap(domain.layout(), nodes, pressure);
  return report;
}

template <int Dim>
double gas_work(const Domain<Dim>& domain, const CellVectors<Dim>& u_bar_star, const CellField& rho,
                const PressureElements<Dim>& elements, double dt, ProjectionWork<Dim>& work) {
  using C = Corners<Dim>;
  const Grid<Dim>& grid = domain.grid;
  const Layout<Dim>& layout = domain.layout();
  const C corners(layout);
  const Box<Dim> nodes = grid.nodes();
  for_each<Node>(layout, nodes, [&](Node n) { work.rhs[n] = 0; });
  for_each_coloured<Cell>(layout, grid.cells(), [&](Cell c, const Index<Dim>& i) {
    if (!elements.bears[c]) return;
    Node corner[C::count];
    bool any = false;
    for (int k = 0; k < C::count; ++k) {
      corner[k] = C::of_cell(layout, c, i, k);
      any = any || (!elements.free[corner[k]] && work.increment[corner[k]] != 0);
    }
    if (!any) return;
    const CellPressure<Dim> cell(grid, corners, elements, c, i);
    for (int a = 0; a < C::count; ++a) {
      const Node na = corner[a];
      if (elements.free[na] || work.increment[na] == 0) continue;
      double outflow = 0;
      for (int d = 0; d < Dim; ++d) outflow += cell.volume * u_bar_star[d][c] * cell.mean.at[a][d];
      for (int b = 0; b < C::count; ++b) outflow -= dt / rho[c] * cell.stiffness[a][b] * work.increment[corner[b]];
      work.rhs[na] += outflow;
    }
  });
  return -dt * sum<Node>(layout, nodes, [&](Node n) { return work.rhs[n] * work.increment[n]; });
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                              \
  template void add_pressure_gradient(const Domain<Dim>&, const NodeField&, const CellField&,                   \
                                      const PressureElements<Dim>&, double, CellVectors<Dim>&);                 \
  template void set_open_pressures(const Domain<Dim>&, NodeField&);                                             \
  template SolveReport solve_pressure(const Domain<Dim>&, Projected, double, const CellVectors<Dim>&,           \
                                      const CellField&, const PressureElements<Dim>&, const NodeField&, double, \
                                      const SolveOptions&, ProjectionWork<Dim>&, NodeField&);                   \
  template double gas_work(const Domain<Dim>&, const CellVectors<Dim>&, const CellField&,                       \
                           const PressureElements<Dim>&, double, ProjectionWork<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
