#include "physics/redistribution.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace quicksand {

namespace {

/// In cells filled less than this the velocity is the quotient of two round-off errors.
constexpr double smallest_filling = 1e-12;

/// Coupling of the cell with index `high` and the one below it along d in -div grad, finite volumes; none where both
/// are the one cell of a ring.
template <int Dim>
double coupling(const Grid<Dim>& grid, int d, const Index<Dim>& high) {
  if (grid.layout().periodic(d) && grid.layout().cells()[d] == 1) return 0;
  return grid.area(d, high) / (0.5 * (grid.width_1d(d, high[d]) + grid.width_1d(d, high[d] - 1)));
}

/// Diagonal of -div grad; `rule(d, s)` gives the ghost rule (its alpha) on side s of axis d.
template <int Dim, class Rule>
double diagonal_entry(const Grid<Dim>& grid, Rule&& rule, const Index<Dim>& i) {
  double diagonal = 0;
  for (int d = 0; d < Dim; ++d) {
    Index<Dim> next = i;
    ++next[d];
    double below = coupling(grid, d, i);
    double above = coupling(grid, d, next);
    // ghost = alpha * mirror: the difference across the side is (1 - alpha) * mirror.
    if (i[d] == 0 && grid.at_boundary(d, 0)) below *= 1 - rule(d, 0).alpha;
    if (i[d] == grid.owned_cells()[d] - 1 && grid.at_boundary(d, 1)) above *= 1 - rule(d, 1).alpha;
    diagonal += below + above;
  }
  return diagonal;
}

/// Sets the diagonal of -div grad in the cells along the sides, by diagonal_entry().
template <int Dim, class Rule>
void set_side_diagonals(const Grid<Dim>& grid, Rule&& rule, CellField& diagonal) {
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (!grid.at_boundary(d, s)) continue;
      Box<Dim> layer = grid.cells();
      (s == 0 ? layer.hi[d] : layer.lo[d]) = s == 0 ? 1 : layer.hi[d] - 1;
      for_each<Cell>(grid.layout(), layer,
                     [&](Cell c, const Index<Dim>& i) { diagonal[c] = diagonal_entry(grid, rule, i); });
    }
  }
}

/// A for volume.
template <int Dim>
StencilMatrix<Dim, Cell> volume_laplacian(const Domain<Dim>& domain) {
  const Grid<Dim>& grid = domain.grid;
  StencilMatrix<Dim, Cell> laplacian(domain.layout(), Stencil::star);
  const auto lower = [&](int d, Cell c) -> double& { return laplacian.lower[static_cast<std::size_t>(d)][c]; };
  for_each_axis<Dim>([&](auto d) {
    for_each<Face>(domain.layout(), grid.faces(d),
                   [&](Face f, const Index<Dim>& i) { lower(d, high_cell(f)) = -coupling(grid, d, i); });
  });
  for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c) {
    double coupled = 0;
    for (int d = 0; d < Dim; ++d) coupled += lower(d, c) + lower(d, c + grid.step(d));
    laplacian.diagonal[c] = -coupled;
  });
  set_side_diagonals(
      grid, [&](int d, int s) { return potential_rule(domain.sides.at(d, s)); }, laplacian.diagonal);
  // None couples out of the grid.
  for (int d = 0; d < Dim; ++d) {
    if (domain.layout().periodic(d)) continue;
    for (const int end : {0, grid.owned_cells()[d]}) {
      Box<Dim> layer = grid.cells();
      layer.lo[d] = end;
      layer.hi[d] = end + 1;
      for_each<Cell>(domain.layout(), layer, [&](Cell c) { lower(d, c) = 0; });
    }
  }
  laplacian.wrap_couplings();
  return laplacian;
}

/// Diagonal of the operator (11) for velocity component e: Laplacian of a vector's component.
/// \param of_volume  that for volume
template <int Dim>
void find_diagonal(const Domain<Dim>& domain, int e, const CellField& of_volume, CellField& diagonal) {
  const Grid<Dim>& grid = domain.grid;
  diagonal = of_volume;
  set_side_diagonals(
      grid,
      [&](int d, int s) {
        // H vanishes on an open side and has no slope on an inflow side, whatever the velocity does there.
        const Side& side = domain.sides.at(d, s);
        return is_passable(side) ? potential_rule(side) : inviscid_velocity_rule(side, d == e);
      },
      diagonal);
  if (e != 0 || !grid.axisymmetric()) return;
  for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    const double r = grid.centre_position(0, i[0]);
    diagonal[c] += grid.volume(i) / (r * r);
  });
}

/// Gives a matrix another diagonal for a while.
template <int Dim>
class OtherDiagonal {
 public:
  explicit OtherDiagonal(StencilMatrix<Dim, Cell>& matrix) : matrix_(matrix), own_(matrix.layout) {
    std::swap(matrix_.diagonal, own_);
  }
  ~OtherDiagonal() { std::swap(matrix_.diagonal, own_); }
  const CellField& own() const { return own_; }
  OtherDiagonal(const OtherDiagonal&) = delete;
  OtherDiagonal& operator=(const OtherDiagonal&) = delete;

 private:
  StencilMatrix<Dim, Cell>& matrix_;
  CellField own_;
};

/// phi -= A H / V; returns the volume that leaves through open sides.
template <int Dim>
double apply_potential(const Domain<Dim>& domain, CellField& H, StencilMatrix<Dim, Cell>& laplacian, CellField& change,
                       CellField& phi) {
  laplacian.apply(H, change);
  for_each<Cell>(domain.layout(), domain.grid.cells(),
                 [&](Cell c, const Index<Dim>& i) { phi[c] -= change[c] / domain.grid.volume(i); });
  return sum<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) { return change[c]; });
}

/// Round-off can leave -1e-17 where a cell gave all it had: the largest neighbour makes up for it. What no neighbour
/// can give counts as having come in from outside. Serial, because such cells are few. \returns the volume that came in
/// so
template <int Dim>
double settle_negative(const Domain<Dim>& domain, CellField& phi) {
  const Grid<Dim>& grid = domain.grid;
  const double deepest = -maximum<Cell>(domain.layout(), grid.cells(), 0.0, [&](Cell c) { return -phi[c]; });
  double created = 0;
  if (deepest >= 0) return created;
  const Rows<Dim> rows(domain.layout(), grid.cells());
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    for (int i = 0; i < rows.length; ++i) {
      const Cell c{rows.start(r) + i};
      if (phi[c] >= 0) continue;
      Cell donor = c;
      for (int d = 0; d < Dim; ++d) {
        for (const int side : {-1, 1}) {
          Index<Dim> index = domain.layout().multi(c.n);
          index[d] += side;
          index = domain.layout().image(index);
          const Cell neighbour = grid.cell(index);
          if (grid.cells().contains(index) && phi[neighbour] > phi[donor]) donor = neighbour;
        }
      }
      const double missing = -phi[c] * grid.volume(c);
      const double given = std::min(missing, std::max(phi[donor], 0.0) * grid.volume(donor));
      phi[donor] -= given / grid.volume(donor);
      phi[c] = 0;
      created += missing - given;
    }
  }
  return created;
}

}  // namespace

template <int Dim>
RedistributionWork<Dim>::RedistributionWork(const Domain<Dim>& domain, const std::vector<Species>& species)
    : H_species(species.size(), CellField(domain.layout())), least_density(std::numeric_limits<double>::infinity()) {
  for (const Species& s : species) least_density = std::min(least_density, smallest_filling * s.density);
}

template <int Dim>
void RedistributionWork<Dim>::release() {
  H = {};
  laplacian = {};
}

template <int Dim>
std::vector<ObstacleReport> redistribute_volume(const Domain<Dim>& domain, const std::vector<Species>& species,
                                                const ObstacleOptions& options, RedistributionWork<Dim>& work,
                                                Fractions& phi, std::vector<double>& escaped) {
  const Grid<Dim>& grid = domain.grid;
  const Layout<Dim>& layout = domain.layout();
  std::vector<ObstacleReport> reports;
  CellField excess(layout);  // (phi~ - limit) V, then what leaves a cell
  CellField volume(layout);
  for_each<Cell>(layout, grid.cells(), [&](Cell c, const Index<Dim>& i) { volume[c] = grid.volume(i); });
  work.laplacian = volume_laplacian(domain);
  work.H = CellField(layout);
  for (std::size_t i = 0; i < phi.size(); ++i) {
    CellField& H_i = work.H_species[i];
    for_each<Cell>(layout, grid.cells(), [&](Cell c) {
      double taken = 0;
      for (std::size_t j = 0; j < i; ++j) taken += phi[j][c];
      excess[c] = (phi[i][c] - std::max(1 - taken, 0.0)) * volume[c];
    });
    reports.push_back(solve_obstacle(work.laplacian, excess, volume, H_i, options));
    if (!reports.back().trivial) {
      escaped[i] += apply_potential(domain, H_i, work.laplacian, excess, phi[i]);
      for_each<Cell>(layout, grid.cells(), [&](Cell c) { work.H[c] += species[i].density * H_i[c]; });
    }
    escaped[i] -= settle_negative(domain, phi[i]);
  }
  return reports;
}

template <int Dim>
SolveReport redistribute_momentum(const Domain<Dim>& domain, const CellVectors<Dim>& momentum_tilde,
                                  const CellField& rho, const SolveOptions& options, RedistributionWork<Dim>& work,
                                  CellVectors<Dim>& u_bar) {
  const Grid<Dim>& grid = domain.grid;
  const Layout<Dim>& layout = domain.layout();
  const auto set_velocity = [&](int e, Cell c, double momentum) {
    u_bar[e][c] = rho[c] > work.least_density ? momentum / rho[c] : 0.0;
  };
  CellField& H = work.H;
  const Box<Dim> box = bounding_box<Cell>(layout, grid.cells(), [&](Cell c) { return H[c] > 0; });
  if (box.empty()) {
    for (int e = 0; e < Dim; ++e) {
      for_each<Cell>(layout, grid.cells(), [&](Cell c) { set_velocity(e, c, momentum_tilde[e][c]); });
    }
    return {.converged = true};
  }
  wrap(layout, grid.cells(), H);
  StencilMatrix<Dim, Cell>& A = work.laplacian;
  const OtherDiagonal<Dim> of_component(A);
  StencilMatrix<Dim, Cell> system(layout, Stencil::star);
  system.box = box;
  CellField y(layout), rhs(layout);
  SolveReport worst{.converged = true};
  for (int e = 0; e < Dim; ++e) {
    find_diagonal(domain, e, of_component.own(), A.diagonal);
    y.fill(0);
    for_each<Cell>(layout, box, [&](Cell c, const Index<Dim>& i) {
      const bool in = H[c] > 0;
      system.diagonal[c] = in ? grid.volume(i) * rho[c] / H[c] + A.diagonal[c] : 1.0;
      for (int d = 0; d < Dim; ++d) {
        const std::size_t k = static_cast<std::size_t>(d);
        system.lower[k][c] = in && H[c - grid.step(d)] > 0 ? A.lower[k][c] : 0.0;
      }
      rhs[c] = in ? grid.volume(i) * momentum_tilde[e][c] : 0.0;
      y[c] = in ? H[c] * momentum_tilde[e][c] / rho[c] : 0.0;
    });
    system.wrap_couplings();
    const SolveReport report = solve(system, rhs, y, options);
    require_converged(report, "momentum redistribution");
    if (report.iterations > worst.iterations) worst = report;
    // In flux form, so that momentum is conserved however well y was solved for.
    A.apply(y, rhs);
    for_each<Cell>(layout, grid.cells(), [&](Cell c, const Index<Dim>& i) {
      set_velocity(e, c, momentum_tilde[e][c] - rhs[c] / grid.volume(i));
    });
  }
  return worst;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                           \
  template struct RedistributionWork<Dim>;                                                                   \
  template std::vector<ObstacleReport> redistribute_volume(const Domain<Dim>&, const std::vector<Species>&,  \
                                                           const ObstacleOptions&, RedistributionWork<Dim>&, \
                                                           Fractions&, std::vector<double>&);                \
  template SolveReport redistribute_momentum(const Domain<Dim>&, const CellVectors<Dim>&, const CellField&,  \
                                             const SolveOptions&, RedistributionWork<Dim>&, CellVectors<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
