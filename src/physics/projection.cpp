#include "physics/projection.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "physics/pressure_operator.hpp"

namespace quicksand {

namespace {

/// Whether a system on a box of nodes is solved without its matrix, behind PFMG of the star part: in space, where
/// factors do not suit.
template <int Dim>
bool suits_operator(const Layout<Dim>& layout, const Box<Dim>& box) {
  for (int d = 0; d < Dim; ++d) {
    if (layout.periodic(d)) return false;
  }
  return Dim == 3 && !suits_factors(layout, box);
}

/// The least pressure given at a node, 0 if there is none. The solver's relative tolerance is to mean differences of
/// pressure, not their height above zero.
template <int Dim>
double least_given(const Domain<Dim>& domain, const NodeMask& free, const NodeField& pressure) {
  constexpr double none = std::numeric_limits<double>::lowest();
  const double negative =
      maximum<Node>(domain.layout(), domain.grid.nodes(), none, [&](Node n) { return free[n] ? none : -pressure[n]; });
  return negative > none ? -negative : 0.0;
}

/// Adds couplings of free nodes to a matrix with a box stencil.
template <int Dim>
class WholeMatrix {
 public:
  explicit WholeMatrix(StencilMatrix<Dim, Node>& matrix) : matrix_(matrix) {
    using C = Corners<Dim>;
    for (int a = 0; a < C::count; ++a) {
      for (int b = 0; b < a; ++b) {
        Index<Dim> between;
        for (int d = 0; d < Dim; ++d) between[d] = C::bit(b, d) - C::bit(a, d);
        const auto found = std::find(matrix.offsets.begin(), matrix.offsets.end(), between);
        offset_[a][b] = static_cast<std::size_t>(found - matrix.offsets.begin());
      }
    }
  }
  /// Corners a >= b of a cell couple by k. \param corner  the cell's
  void couple(const Node* corner, const NodeMask&, int a, int b, double k) {
    (a == b ? matrix_.diagonal[corner[a]] : matrix_.lower[offset_[a][b]][corner[a]]) += k;
  }

 private:
  StencilMatrix<Dim, Node>& matrix_;
  std::size_t offset_[1 << Dim][1 << Dim] =
      {};  ///< lower offset that leads from the higher to the lower, [a][b] for a > b
};

/// Adds couplings of free nodes to the star part of their matrix, see star_part(): edges to the couplings, the sums of
/// the rows to the diagonal, until finish() is called.
template <int Dim>
class StarPart {
 public:
  explicit StarPart(StencilMatrix<Dim, Node>& star) : star_(star) {}
  void couple(const Node* corner, const NodeMask& free, int a, int b, double k) {
    star_.diagonal[corner[a]] += k;
    if (a == b) return;
    star_.diagonal[corner[b]] += k;
    const int apart = a ^ b;
    for (int d = 0; d < Dim; ++d) {
      const int along = 1 << d;
      if (!(apart & along)) continue;
      for (const int end : {a, b}) {
        // Half of it goes to either of two edges, all to the one that joins the corners.
        if (free[corner[end ^ along]]) star_.lower[static_cast<std::size_t>(d)][corner[end | along]] += k / 2;
      }
    }
  }
  void finish(const NodeMask& free) {
    for (NodeField& edge : star_.lower) {
      for_each<Node>(star_.layout, star_.box, [&](Node n) { edge[n] = std::min(edge[n], 0.0); });
    }
    for_each<Node>(star_.layout, star_.box, [&](Node n) {
      if (!free[n]) return;
      for (std::size_t d = 0; d < star_.lower.size(); ++d) {
        star_.diagonal[n] -= star_.lower[d][n] + star_.lower[d][n + star_.steps[d]];
      }
    });
  }

 private:
  StencilMatrix<Dim, Node>& star_;
};

/// Matrix dt K on the free nodes, and the right-hand side: sum V u-bar* . grad N, the remembered surplus of the
/// stiffness on the last pressure, less what the given nodes contribute.
/// \param increment  the last pressure on free nodes, the given one on others
/// \param matrix     of zeros, or with what another box left
/// \param whole      WholeMatrix or StarPart of it
template <int Dim, class Couplings>
void assemble(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellField& rho,
              const PressureElements<Dim>& elements, double dt, double memory, const NodeField& increment,
              StencilMatrix<Dim, Node>& matrix, Couplings&& couplings, NodeField& rhs) {
  using C = Corners<Dim>;
  const Grid<Dim>& grid = domain.grid;
  const Layout<Dim>& layout = domain.layout();
  const C corners(layout);
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
        if (a >= b && free[nb]) couplings.couple(corner, free, a, b, k);
        if (!free[nb]) source -= k * increment[nb];
        if (memory > 0) source += memory * scale * cell.surplus(a, b) * increment[nb];
      }
      rhs[na] += source;
    }
  });
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
                           const CellField& rho, const PressureElements<Dim>& elements, double dt,
                           const SolveOptions& options, ProjectionWork<Dim>& work, NodeField& pressure) {
  const Box<Dim> nodes = domain.grid.nodes();
  const double reference = least_given(domain, elements.free, pressure);
  const auto set_increment = [&] {
    for_each<Node>(domain.layout(), nodes, [&](Node n) { work.increment[n] = pressure[n] - reference; });
  };
  set_increment();
  const Box<Dim> box = bounding_box<Node>(domain.layout(), nodes, [&](Node n) { return elements.free[n] != 0; });
  SolveReport report{.converged = true};
  if (!box.empty()) {
    const auto assemble_with = [&](StencilMatrix<Dim, Node>& matrix, auto&& couplings) {
      matrix.box = box;
      assemble(domain, u_bar_star, rho, elements, dt, memory, work.increment, matrix, couplings, work.rhs);
      if (what == Projected::velocity) add_inflow(domain, elements, work);
    };
    report.converged = false;
    if (options.method == Method::automatic && suits_operator(domain.layout(), box)) {
      StencilMatrix<Dim, Node> star(domain.layout(), Stencil::star);
      StarPart<Dim> couplings(star);
      assemble_with(star, couplings);
      couplings.finish(elements.free);
      std::optional<PressureOperator<Dim>> K;  // made when the star part has gone
      for_each<Node>(domain.layout(), nodes,
                     [&](Node n) { work.increment[n] = elements.free[n] ? work.increment[n] : 0.0; });
      const auto apply = [&](const NodeField& x, NodeField& y) {
        if (!K) K.emplace(domain, rho, elements, dt, box);
        K->apply(x, y);
      };
      report = solve<Dim, Node>(apply, std::move(star), work.rhs, work.increment, options);
      if (!report.converged) set_increment();
    }
    if (!report.converged) {
      StencilMatrix<Dim, Node> matrix(domain.layout(), Stencil::box);
      assemble_with(matrix, WholeMatrix<Dim>(matrix));
      matrix.wrap_couplings();
      const int before = report.iterations;
      SolveOptions next = options;
      if (before > 0) next.method = Method::smg;  // PFMG has had its chance
      report = solve(matrix, work.rhs, work.increment, next);
      report.iterations += before;
    }
    require_converged(report, "pressure projection");
    for_each<Node>(domain.layout(), nodes, [&](Node n) {
      if (elements.free[n]) pressure[n] = reference + work.increment[n];
    });
    set_increment();  // solves leave 0 on given nodes
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

#define QUICKSAND_INSTANTIATE(Dim)                                                                                 \
  template void add_pressure_gradient(const Domain<Dim>&, const NodeField&, const CellField&,                      \
                                      const PressureElements<Dim>&, double, CellVectors<Dim>&);                    \
  template void set_open_pressures(const Domain<Dim>&, NodeField&);                                                \
  template SolveReport solve_pressure(const Domain<Dim>&, Projected, double, const CellVectors<Dim>&,              \
                                      const CellField&, const PressureElements<Dim>&, double, const SolveOptions&, \
                                      ProjectionWork<Dim>&, NodeField&);                                           \
  template double gas_work(const Domain<Dim>&, const CellVectors<Dim>&, const CellField&,                          \
                           const PressureElements<Dim>&, double, ProjectionWork<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
