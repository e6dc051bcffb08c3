#pragma once
/// \file
/// Where the nodal pressure acts, and how it is averaged over faces that a surface or an interface cuts.
///
/// Along an edge between two nodes at rest or in common motion the pressure's slope is proportional to the density,
/// which jumps where a plane (surface.hpp) crosses the edge. The mean of such a kinked profile weighs the two nodes by
/// the lever of the mass on the edge: the low node by the distance of the mass's centre from it, in parts of the edge.
/// Even mass gives 1/2, a film of height f on the low node f/2, which with p = 0 above is the exact force on its side.
/// A cell's force is the difference of its faces' means, so that what one cell gives its neighbour takes, and gas
/// and liquid or two liquids are treated alike.
#include <vector>

#include "core/domain.hpp"
#include "core/sparse_field.hpp"
#include "physics/mixture.hpp"
#include "physics/surface.hpp"

namespace quicksand {

/// A cell filled less bears no pressure: the gas pressure then lies on its faces.
inline constexpr double pressureless_fraction = 1e-3;
/// A cell between liquid on all sides that is filled less is a gap, and not incompressible.
inline constexpr double gap_fraction = 0.25;

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
  /// Corner k of the cell with multi-index i, at the low end of a periodic axis that the cell ends.
  static Node of_cell(const Layout<Dim>& layout, Cell c, const Index<Dim>& i, int k) {
    Node n = low_node(c);
    for (int d = 0; d < Dim; ++d) n = n + (layout.image(d, i[d] + bit(k, d)) - i[d]) * layout.step(d);
    return n;
  }
};

/// Derivatives of the corners' shape functions, averaged over a cell: [corner][axis].
template <int Dim>
struct MeanGradient {
  double at[1 << Dim][Dim];
};

/// Where pressure acts and is solved for, and the levers of cut edges.
template <int Dim>
struct PressureElements {
  CellMask bears;  ///< cells in which the pressure's gradient acts
  NodeMask free;   ///< nodes whose pressure is solved for
  CellMask cut;    ///< owned cells with an edge whose mass is not even
  /// Weight of the low node of the edge that begins at a node, per axis, where a cell at one of these edges is cut by a
  /// plane. Elsewhere it is that of the linear element.
  SparseField<Node, Vec<Dim>> lever;

  explicit PressureElements(const Layout<Dim>& layout) : bears(layout), free(layout), cut(layout), lever(layout) {}

  /// Mean gradient by the levers, in cell c with multi-index i; where nothing is cut that of the bilinear element.
  MeanGradient<Dim> gradient(const Grid<Dim>& grid, const Corners<Dim>& corners, Cell c, const Index<Dim>& i) const;
};

/// Mean gradient of the bilinear (trilinear) element.
template <int Dim>
MeanGradient<Dim> even_gradient(const Grid<Dim>& grid, const Index<Dim>& i);

/// Marks the cells that hold enough liquid to bear pressure, ghosts included.
template <int Dim>
void mark_bearing_cells(const Grid<Dim>& grid, const CellField& total, CellMask& bears);

/// Finds gaps, free nodes and levers from the marked cells, the fractions and the planes.
///
/// A node is free if all cells around it, in the domain or mirrored, bear pressure, and none lies beyond an open side.
/// A gap, filled less than gap_fraction with free nodes on all corners, is taken out of `bears`.
template <int Dim>
void find_pressure_elements(const Domain<Dim>& domain, const std::vector<Species>& species, const Fractions& phi,
                            const CellField& total, const Interfaces<Dim>& interfaces, PressureElements<Dim>& elements);

extern template struct PressureElements<2>;
extern template struct PressureElements<3>;

}  // namespace quicksand
