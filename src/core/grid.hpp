#pragma once
/// \file
/// Rectilinear grids: planar 2-D (x, z), axisymmetric (r, z) and 3-D (x, y, z). Volumes, areas and widths are
/// products of numbers along the axes.
#include <array>
#include <vector>

#include "core/field.hpp"
#include "core/layout.hpp"
#include "core/loop.hpp"

namespace quicksand {

enum class Geometry { planar, axisymmetric, cartesian };

/// Integrals of the linear shape functions N0, N1 over one interval of an axis with the axis' weight w (1, or r on the
/// radial axis): the building blocks of the bilinear and trilinear elements of the nodal pressure.
struct LineElement {
  double stiffness;    ///< integral of w N1'^2 = -integral of w N0' N1'
  double mass[2][2];   ///< integral of w Na Nb
  double fraction[2];  ///< integral of w Na over integral of w
};

/// Grid of `Dim` rectilinear axes. The last axis is vertical. Lengths in the unit of the case.
///
/// A grid owns a box of the cells of the global axes. Fields hold the owned cells and `ghosts` layers around them;
/// ghost cells beyond the domain mirror the widths of the cells inside, or repeat them where the axis is periodic. For
/// axisymmetric grids axis 0 is the radius and all volumes and areas are per radian, so that r enters here and in the
/// hoop strain only.
template <int Dim>
class Grid {
 public:
  /// \param faces     increasing face coordinates of the global axes, at least two each
  /// \param owned     owned cells as a box of global cell numbers
  /// \param periodic  axes that go on at their low end where they reach the high one
  /// \throws InputError where an axis does not increase, an axisymmetric grid begins at r < 0 or the radius is periodic
  Grid(std::array<std::vector<double>, Dim> faces, Geometry geometry, const Box<Dim>& owned,
       const AxisFlags<Dim>& periodic = {});
  /// Grid that owns all cells of its axes, none of them periodic.
  Grid(std::array<std::vector<double>, Dim> faces, Geometry geometry);
  /// The same grid with these axes periodic and no others.
  Grid with_periodic(const AxisFlags<Dim>& periodic) const;

  Geometry geometry() const { return geometry_; }
  bool axisymmetric() const { return geometry_ == Geometry::axisymmetric; }
  const Layout<Dim>& layout() const { return layout_; }
  Step step(int d) const { return layout_.step(d); }
  const Index<Dim>& owned_cells() const { return layout_.cells(); }
  /// Cells of the whole domain, of which this grid owns owned_global().
  const Index<Dim>& global_cells() const { return global_cells_; }
  const Box<Dim>& owned_global() const { return owned_global_; }
  /// Whether the owned box ends at the domain's low (side 0) or high (side 1) boundary along d. A periodic axis has
  /// none.
  bool at_boundary(int d, int side) const {
    if (periodic_[d]) return false;
    return side == 0 ? owned_global_.lo[d] == 0 : owned_global_.hi[d] == global_cells_[d];
  }

  Box<Dim> cells() const { return {Index<Dim>{}, layout_.cells()}; }  ///< owned cells
  Box<Dim> faces(int d) const { return extend_high(cells(), d); }     ///< faces of owned cells along d
  /// Nodes of owned cells, each once: on a periodic axis that is owned as a whole the last one is the first again.
  Box<Dim> nodes() const;
  /// Cell multi-index (owned cells start at 0) to flat index.
  Cell cell(const Index<Dim>& i) const { return {layout_.flat(i)}; }

  /// Volume of the cell with index i, ghosts included.
  double volume(const Index<Dim>& i) const {
    double volume = 1;
    for (int d = 0; d < Dim; ++d) volume *= axes_[at(d)].measure[at(i[d] + ghosts)];
    return volume;
  }
  /// The same for a single cell: loops over a grid know the index, which takes divisions to find.
  double volume(Cell c) const { return volume(layout_.multi(c.n)); }

  /// 1-D metrics along axis d for the owned index i and its ghosts, -ghosts <= i < n + ghosts (faces: <= n + ghosts).
  double face_position(int d, int i) const { return axes_[at(d)].face[at(i + ghosts)]; }
  double centre_position(int d, int i) const { return axes_[at(d)].centre[at(i + ghosts)]; }
  double width_1d(int d, int i) const { return axes_[at(d)].width[at(i + ghosts)]; }
  /// Distance of the centres of the cells before and after cell i; both have to be there.
  double spacing_around(int d, int i) const { return axes_[at(d)].spacing_around[at(i + ghosts)]; }
  const LineElement& line_element(int d, int i) const { return axes_[at(d)].element[at(i + ghosts)]; }
  Vec<Dim> centre(const Index<Dim>& i) const;
  /// Area of the low face along d of the cell with index i, ghosts included.
  double area(int d, const Index<Dim>& i) const {
    double area = axes_[at(d)].face_weight[at(i[d] + ghosts)];
    for (int e = 0; e < Dim; ++e) {
      if (e != d) area *= axes_[at(e)].measure[at(i[e] + ghosts)];
    }
    return area;
  }

  /// Face coordinates of the whole domain along d.
  const std::vector<double>& global_faces(int d) const { return global_faces_[at(d)]; }
  double smallest_width() const { return smallest_width_; }

 private:
  struct Axis {
    std::vector<double> face, centre, width;
    std::vector<double> spacing_around;
    std::vector<double> measure;      ///< width times the weight of the axis, |r| on a radius and else 1
    std::vector<double> face_weight;  ///< the weight on the faces
    std::vector<LineElement> element;
  };
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  void store_axis(int d);

  std::array<std::vector<double>, Dim> global_faces_;
  Geometry geometry_;
  AxisFlags<Dim> periodic_;
  Index<Dim> global_cells_;
  Box<Dim> owned_global_;
  Layout<Dim> layout_;
  std::array<Axis, Dim> axes_;
  double smallest_width_ = 0;
};

extern template class Grid<2>;
extern template class Grid<3>;

}  // namespace quicksand
