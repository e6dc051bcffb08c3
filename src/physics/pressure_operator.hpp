#pragma once
/// \file
/// What the pressure in a cell does, and the projection's operator dt K made of it.
#include <array>
#include <vector>

#include "core/domain.hpp"
#include "physics/pressure_elements.hpp"

namespace quicksand {

/// What pressures at the corners of a cell do in it.
template <int Dim>
struct CellPressure {
  double volume;
  MeanGradient<Dim> mean;                ///< levers and all
  double stiffness[1 << Dim][1 << Dim];  ///< integral of grad N_a . grad N_b, its part of mean gradients that of `mean`

  CellPressure(const Grid<Dim>& grid, const Corners<Dim>& corners, const PressureElements<Dim>& elements, Cell c,
               const Index<Dim>& i);
  /// Part of the stiffness that is not of mean gradients.
  double surplus(int a, int b) const { return stiffness[a][b] - volume * product(mean, a, b); }

 private:
  static double product(const MeanGradient<Dim>& g, int a, int b) {
    double sum = 0;
    for (int d = 0; d < Dim; ++d) sum += g.at[a][d] * g.at[b][d];
    return sum;
  }
};

/// dt K on the free nodes of a box, without a matrix: from factors along the axes in cells of even mass, from stored
/// element matrices in the few that are cut. In space the matrix would take 14 numbers per node, and three times as
/// long to read as these products take. Not for periodic axes.
template <int Dim>
class PressureOperator {
 public:
  /// \param rho  rho^{n+1}
  /// \param box  of nodes, all free ones in it
  PressureOperator(const Domain<Dim>& domain, const CellField& rho, const PressureElements<Dim>& elements, double dt,
                   const Box<Dim>& box);
  /// y = dt K x on the free nodes of the box, 0 on its others. \param x  0 on nodes that are not free
  void apply(const NodeField& x, NodeField& y) const;

 private:
  static constexpr int corners = 1 << Dim;
  using ElementMatrix = std::array<double, static_cast<std::size_t>(corners*(corners + 1) / 2)>;
  /// Integrals of the elements along x.
  struct AlongX {
    std::vector<double> stiffness, mass_low, mass_across, mass_high;
  };
  struct RowFactors;

  /// Adds what the even cells of a row give to nodes next to each other in a row, at most a chunk of them.
  /// \param first  number of the first node along x
  void add_even_cells(const NodeField& x, const RowFactors& factors, std::ptrdiff_t start, int first, int length,
                      double* y) const;
  /// The same of cut cells, to any number of nodes. \param transverse  see RowFactors
  void add_cut_cells(const NodeField& x, int transverse, Cell first_cell, int length, double* y) const;
  void find_cut_cells(const CellField& rho, double dt);

  const Domain<Dim>& domain_;
  const PressureElements<Dim>& elements_;
  Box<Dim> box_;
  AlongX along_x_;                           ///< from the first ghost cell on
  CellField scale_;                          ///< dt / rho in even cells that bear pressure, 0 in all others
  std::vector<Cell> cut_cells_;              ///< that bear pressure, in order
  std::vector<ElementMatrix> cut_matrices_;  ///< theirs: lower halves, row by row
  /// Where the cut cells of a row begin in these, by the row's flat number over the length of a row; and their end.
  std::vector<std::size_t> first_cut_;
};

extern template struct CellPressure<2>;
extern template struct CellPressure<3>;
extern template class PressureOperator<2>;
extern template class PressureOperator<3>;

}  // namespace quicksand
