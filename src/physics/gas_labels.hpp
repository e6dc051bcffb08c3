#pragma once
/// \file
/// Connected regions of gas: which cells hang together, and whose the gas in part-filled cells is.
#include <vector>

#include "core/domain.hpp"

namespace quicksand {

/// One integer per cell.
using CellLabels = Field<Cell, int>;

/// A connected region of gas cells.
struct GasComponent {
  double volume = 0;  ///< of all gas that counts as the region's, per radian in axisymmetric flows
  bool open = false;  ///< touches an open side of the domain
  int outside = 0;    ///< its cells outside D; the others are part-filled ones that still connect it
  Cell emptiest;      ///< the cell of least sum phi (the first of several)
};

/// Regions of gas, numbered from 0 in the order of their first cells.
struct GasLabels {
  CellLabels component;  ///< of gas cells; no_component elsewhere
  CellLabels owner;      ///< region whose gas a cell's is, in gas cells the component; no_component if there is no gas
  CellLabels parent;     ///< of gas cells: region id of the step before that the gas comes from, 0 if unknown
  std::vector<GasComponent> components;

  static constexpr int no_component = -1;
  /// Without fields, until label_gas() is called.
  GasLabels() = default;
  template <int Dim>
  explicit GasLabels(const Layout<Dim>& layout)
      : component(layout, no_component), owner(layout, no_component), parent(layout) {}
};

/// Labels the connected regions of gas and measures them.
///
/// Gas cells are those outside D, sum phi < 1 - eps, and those filled less than half that were gas cells of a region in
/// the last step. Cells hang together across faces that are not closed. A part-filled cell connects only what its own
/// region was part of: so drops and films thinner than half a cell neither split a region nor open it to another.
///
/// The gas in all other cells, sum (1 - sum phi) V, counts for the gas cells across their faces, in equal shares where
/// these belong to several regions, and further inside the liquid for the region nearest in steps from cell to cell. A
/// cell that joins or leaves D does not change a volume, and the volumes of all regions and of the liquid add up to
/// that of the domain (if there is a region at all).
///
/// Serial, in a fixed order.
/// \param total      sum phi, owned cells
/// \param threshold  eps of D
/// \param previous   region id of the last step's gas cells, 0 elsewhere
template <int Dim>
void label_gas(const Domain<Dim>& domain, const CellField& total, double threshold, const CellLabels& previous,
               GasLabels& labels);

}  // namespace quicksand
