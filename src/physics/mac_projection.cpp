#include "physics/mac_projection.hpp"

namespace quicksand {

namespace {

/// 1 / (rho h) over the liquid part of the way between the two cells of a face; 0 where the velocity is given (closed
/// and inflow sides) and outside D. On open sides q = 0.
template <int Dim>
double mobility(const Domain<Dim>& domain, const CellField& rho, const CellMask& liquid, int d, Face f) {
  const Cell high = high_cell(f);
  const Cell low = high - domain.grid.step(d);
  const auto resists = [&](Cell c) { return liquid[c] && domain.beyond[c] == Beyond::nothing; };
  const double resistance = (resists(low) ? 0.5 * rho[low] * domain.grid.width(d, low) : 0.0) +
                            (resists(high) ? 0.5 * rho[high] * domain.grid.width(d, high) : 0.0);
  const bool given = domain.beyond[low] == Beyond::inflow || domain.beyond[high] == Beyond::inflow;
  return resistance > 0 && domain.aperture[d][f] > 0 && !given ? 1 / resistance : 0.0;
}

template <int Dim>
void assemble(const Domain<Dim>& domain, const CellField& rho, const CellMask& liquid,
              StencilMatrix<Dim, Cell>& matrix) {
  const Grid<Dim>& grid = domain.grid;
  const auto coefficient = [&](int d, Face f) { return domain.aperture[d][f] * mobility(domain, rho, liquid, d, f); };
  for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c) {
    double diagonal = 0;
    for (int d = 0; d < Dim; ++d) {
      const double below = coefficient(d, low_face(c));
      diagonal += below + coefficient(d, low_face(c + grid.step(d)));
      // A low neighbour beyond the owned box counts as q = 0: it lies beyond an open side, or there is no coefficient.
      matrix.lower[static_cast<std::size_t>(d)][c] = liquid[c] && liquid[c - grid.step(d)] ? -below : 0.0;
    }
    matrix.diagonal[c] = liquid[c] && diagonal > 0 ? diagonal : 1.0;
  });
  matrix.wrap_couplings();
}

}  // namespace

template <int Dim>
SolveReport project_face_velocities(const Domain<Dim>& domain, const CellField& rho, const CellMask& liquid,
                                    const SolveOptions& options, MacProjectionWork<Dim>& work,
                                    FaceScalars<Dim>& u_mac) {
  const Grid<Dim>& grid = domain.grid;
  const Box<Dim> box = bounding_box<Cell>(domain.layout(), grid.cells(), [&](Cell c) { return liquid[c] != 0; });
  if (box.empty()) return {.converged = true};
  StencilMatrix<Dim, Cell> matrix(domain.layout(), Stencil::star);
  matrix.box = box;
  assemble(domain, rho, liquid, matrix);
  CellField divergence(domain.layout());
  for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c) {
    double out = 0;
    for (int d = 0; d < Dim; ++d) {
      const Face above = low_face(c + grid.step(d));
      out += domain.aperture[d][above] * u_mac[d][above] - domain.aperture[d][low_face(c)] * u_mac[d][low_face(c)];
    }
    divergence[c] = liquid[c] ? -out : 0.0;
    if (!liquid[c]) work.potential[c] = 0;
  });
  const SolveReport report = solve(matrix, divergence, work.potential, options);
  require_converged(report, "MAC projection");
  wrap(domain.layout(), grid.cells(), work.potential);
  for (int d = 0; d < Dim; ++d) {
    for_each<Face>(domain.layout(), grid.faces(d), [&](Face f) {
      const Cell high = high_cell(f);
      const Cell low = high - grid.step(d);
      u_mac[d][f] -= mobility(domain, rho, liquid, d, f) *
                     ((liquid[high] ? work.potential[high] : 0.0) - (liquid[low] ? work.potential[low] : 0.0));
    });
  }
  return report;
}

template SolveReport project_face_velocities(const Domain<2>&, const CellField&, const CellMask&, const SolveOptions&,
                                             MacProjectionWork<2>&, FaceScalars<2>&);
template SolveReport project_face_velocities(const Domain<3>&, const CellField&, const CellMask&, const SolveOptions&,
                                             MacProjectionWork<3>&, FaceScalars<3>&);

}  // namespace quicksand
