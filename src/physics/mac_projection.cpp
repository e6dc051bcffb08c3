#include "physics/mac_projection.hpp"

namespace quicksand {

namespace {

/// Voids of a greater part of a cell may be bubbles that the grid no longer resolves.
constexpr double largest_void = 0.25;

/// Share of a void that is filled in a step.
constexpr double filled_share = 0.5;

/// Whether all cells around one are in D.
template <int Dim>
bool inside(const Layout<Dim>& layout, const CellMask& liquid, Cell c) {
  constexpr int count = Dim == 2 ? 9 : 27;
  for (int k = 0; k < count; ++k) {
    Cell at = c;
    for (int d = 0, rest = k; d < Dim; ++d, rest /= 3) at = at + (rest % 3 - 1) * layout.step(d);
    if (!liquid[at]) return false;
  }
  return true;
}

template <int Dim>
bool has_surface(const Domain<Dim>& domain, const CellMask& liquid) {
  for (int d = 0; d < Dim; ++d) {
    if (is_open(domain.sides.at(d, 0)) || is_open(domain.sides.at(d, 1))) return true;
  }
  const Box<Dim> cells = domain.grid.cells();
  return maximum<Cell>(domain.layout(), cells, 0.0, [&](Cell c) { return liquid[c] ? 0.0 : 1.0; }) > 0;
}

/// 1 / (rho h) over the liquid part of the way between the two cells of a face, i being the index of the upper one; 0
/// where the velocity is given (closed and inflow sides) and outside D. On open sides q = 0.
template <int Dim>
double mobility(const Domain<Dim>& domain, const CellField& rho, const CellMask& liquid, int d, const Index<Dim>& i,
                Face f) {
  const Cell high = high_cell(f);
  const Cell low = high - domain.grid.step(d);
  const auto resists = [&](Cell c) { return liquid[c] && domain.beyond[c] == Beyond::nothing; };
  const double resistance = (resists(low) ? 0.5 * rho[low] * domain.grid.width_1d(d, i[d] - 1) : 0.0) +
                            (resists(high) ? 0.5 * rho[high] * domain.grid.width_1d(d, i[d]) : 0.0);
  const bool given = domain.beyond[low] == Beyond::inflow || domain.beyond[high] == Beyond::inflow;
  return resistance > 0 && domain.passes(d, i) && !given ? 1 / resistance : 0.0;
}

template <int Dim>
void assemble(const Domain<Dim>& domain, const CellField& rho, const CellMask& liquid,
              StencilMatrix<Dim, Cell>& matrix) {
  const Grid<Dim>& grid = domain.grid;
  const auto coefficient = [&](int d, Cell c) -> double& { return matrix.lower[static_cast<std::size_t>(d)][c]; };
  for_each_axis<Dim>([&](auto d) {
    for_each<Face>(domain.layout(), grid.faces(d), [&](Face f, const Index<Dim>& i) {
      coefficient(d, high_cell(f)) = domain.aperture(d, i) * mobility(domain, rho, liquid, d, i, f);
    });
  });
  for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c) {
    double diagonal = 0;
    for (int d = 0; d < Dim; ++d) diagonal += coefficient(d, c) + coefficient(d, c + grid.step(d));
    matrix.diagonal[c] = liquid[c] && diagonal > 0 ? diagonal : 1.0;
  });
  for (int d = 0; d < Dim; ++d) {
    for_each<Face>(domain.layout(), grid.faces(d), [&](Face f) {
      const Cell high = high_cell(f);
      const Cell low = high - grid.step(d);
      // Beyond an open side q = 0, whatever is there.
      const bool inside = domain.beyond[low] == Beyond::nothing && domain.beyond[high] == Beyond::nothing;
      coefficient(d, high) = inside && liquid[low] && liquid[high] ? -coefficient(d, high) : 0.0;
    });
  }
  matrix.wrap_couplings();
}

}  // namespace

template <int Dim>
CellField find_voids(const Domain<Dim>& domain, const CellField& total, const CellMask& liquid, double dt) {
  CellField inflow(domain.layout());
  const Grid<Dim>& grid = domain.grid;
  const bool fill = has_surface(domain, liquid);
  for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    const bool lacks = fill && total[c] < 1 && total[c] > 1 - largest_void && inside(domain.layout(), liquid, c);
    inflow[c] = lacks ? filled_share * (1 - total[c]) * grid.volume(i) / dt : 0.0;
  });
  return inflow;
}

template <int Dim>
SolveReport project_face_velocities(const Domain<Dim>& domain, const CellField& rho, const CellMask& liquid,
                                    CellField inflow, const SolveOptions& options, CellField& potential,
                                    FaceScalars<Dim>& u_mac) {
  const Grid<Dim>& grid = domain.grid;
  const Box<Dim> box = bounding_box<Cell>(domain.layout(), grid.cells(), [&](Cell c) { return liquid[c] != 0; });
  if (box.empty()) return {.converged = true};
  StencilMatrix<Dim, Cell> matrix(domain.layout(), Stencil::star);
  matrix.box = box;
  assemble(domain, rho, liquid, matrix);
  CellField& source = inflow;  // the right-hand side
  for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    double out = 0;
    for (int d = 0; d < Dim; ++d) {
      const Face above = low_face(c + grid.step(d));
      out += domain.aperture(d, shifted(i, d, 1)) * u_mac[d][above] - domain.aperture(d, i) * u_mac[d][low_face(c)];
    }
    source[c] = liquid[c] ? -out - inflow[c] : 0.0;
    if (!liquid[c]) potential[c] = 0;
  });
  const SolveReport report = solve(matrix, source, potential, options);
  require_converged(report, "MAC projection");
  wrap(domain.layout(), grid.cells(), potential);
  for_each_axis<Dim>([&](auto d) {
    for_each<Face>(domain.layout(), grid.faces(d), [&](Face f, const Index<Dim>& i) {
      const Cell high = high_cell(f);
      const Cell low = high - grid.step(d);
      u_mac[d][f] -= mobility(domain, rho, liquid, d, i, f) *
                     ((liquid[high] ? potential[high] : 0.0) - (liquid[low] ? potential[low] : 0.0));
    });
  });
  return report;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                               \
  template CellField find_voids(const Domain<Dim>&, const CellField&, const CellMask&, double);                  \
  template SolveReport project_face_velocities(const Domain<Dim>&, const CellField&, const CellMask&, CellField, \
                                               const SolveOptions&, CellField&, FaceScalars<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
