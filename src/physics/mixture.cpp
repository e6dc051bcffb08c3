#include "physics/mixture.hpp"

namespace quicksand {

template <int Dim>
void sum_fractions(const Grid<Dim>& grid, const Fractions& phi, CellField& total) {
  for_each<Cell>(grid.layout(), grow(grid.cells(), ghosts), [&](Cell c) {
    double s = 0;
    for (const CellField& phi_i : phi) s += phi_i[c];
    total[c] = s;
  });
}

template <int Dim>
void mix_density(const Grid<Dim>& grid, const std::vector<Species>& species, const Fractions& phi, CellField& rho) {
  for_each<Cell>(grid.layout(), grow(grid.cells(), ghosts), [&](Cell c) {
    double s = 0;
    for (std::size_t i = 0; i < phi.size(); ++i) s += species[i].density * phi[i][c];
    rho[c] = s;
  });
}

template <int Dim>
void mark_liquid(const Grid<Dim>& grid, const CellField& total, double threshold, CellMask& liquid) {
  for_each<Cell>(grid.layout(), grow(grid.cells(), ghosts),
                 [&](Cell c) { liquid[c] = total[c] >= 1 - threshold ? 1 : 0; });
}

template void sum_fractions(const Grid<2>&, const Fractions&, CellField&);
template void sum_fractions(const Grid<3>&, const Fractions&, CellField&);
template void mix_density(const Grid<2>&, const std::vector<Species>&, const Fractions&, CellField&);
template void mix_density(const Grid<3>&, const std::vector<Species>&, const Fractions&, CellField&);
template void mark_liquid(const Grid<2>&, const CellField&, double, CellMask&);
template void mark_liquid(const Grid<3>&, const CellField&, double, CellMask&);

}  // namespace quicksand
