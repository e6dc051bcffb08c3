#include "physics/pressure_elements.hpp"

#include <algorithm>
#include <limits>

namespace quicksand {

namespace {

/// An edge that is filled less has no lever of its own: round-off should not decide on it.
constexpr double negligible_filling = 1e-9;

/// Mass on an edge and its first moment, by the edge's length.
struct EdgeMass {
  double mass = 0;
  double moment = 0;
};

/// Part 0 <= t <= 1 of an edge.
struct Interval {
  double low = 0;
  double high = 1;
};

/// Part of a cell's edge along d that a region with this plane fills; corner k is the edge's low end.
template <int Dim>
Interval filled_part(const CellPlane<Dim>& plane, int k, int d) {
  double depth = plane.offset;
  for (int e = 0; e < Dim; ++e) {
    if (e != d && Corners<Dim>::bit(k, e)) depth -= plane.normal[e];
  }
  const double slope = plane.normal[d];
  Interval part;
  if (slope > 0) part.high = std::clamp(depth / slope, 0.0, 1.0);
  if (slope < 0) part.low = std::clamp(depth / slope, 0.0, 1.0);
  if (slope == 0 && depth < 0) part.high = 0;
  return part;
}

/// Finds what is on edges.
template <int Dim>
class Edges {
 public:
  Edges(const Domain<Dim>& domain, const std::vector<Species>& species, const Fractions& phi,
        const Interfaces<Dim>& interfaces)
      : corners_(domain.layout()), species_(species), phi_(phi), interfaces_(interfaces) {
    for (const Species& s : species) negligible_ = std::min(negligible_, negligible_filling * s.density);
  }

  /// Whether a cell around the edge along d that begins at a node is cut by a plane.
  bool at_cut(const CellMask& cut, Node n, int d) const {
    bool any = false;
    for_each_cell(n, d, [&](Cell c, int) { any = any || cut[c]; });
    return any;
  }
  /// Lever of the edge along d that begins at the node with index i; `even` where it holds next to nothing.
  double lever(Node n, int d, double even) const {
    EdgeMass edge;
    for_each_cell(n, d, [&](Cell c, int k) { add(6 * even - 2, c, k, d, edge); });
    return edge.mass > negligible_ ? std::clamp(edge.moment / edge.mass, 0.0, 1.0) : even;
  }

 private:
  /// Cells around the edge along d that begins at a node are those at the node less corners.step[k], for the k without
  /// bit d; seen from such a cell the edge begins at its corner k.
  template <class Body>
  void for_each_cell(Node n, int d, Body&& body) const {
    for (int k = 0; k < Corners<Dim>::count; ++k) {
      if (Corners<Dim>::bit(k, d) == 0) body(high_cell(n) - corners_.step[k], k);
    }
  }
  /// Adds what a cell holds on its edge along d that begins at corner k. The moment of the part up to t is
  /// integral of W, the integral from 0 of the axis' normalised weight w_0 + (2 - 2 w_0) s; w_0 = 1 but for the radius.
  void add(double w_0, Cell c, int k, int d, EdgeMass& edge) const {
    const auto integral = [&](double t) { return t * t * (w_0 / 2 + (1 - w_0) * t / 3); };
    EdgeMass before;
    for (std::size_t s = 0; s < species_.size(); ++s) {
      EdgeMass region;
      if (interfaces_[s].has(c)) {
        const Interval part = filled_part(interfaces_[s][c], k, d);
        region = {part.high - part.low, integral(part.high) - integral(part.low)};
      } else {
        const double filling = std::clamp(region_fraction(phi_, s, c), 0.0, 1.0);
        region = {filling, filling * integral(1)};
      }
      // Where planes of nested regions cross, the inner one has the say.
      edge.mass += species_[s].density * std::max(region.mass - before.mass, 0.0);
      edge.moment += species_[s].density * std::max(region.moment - before.moment, 0.0);
      before = {std::max(region.mass, before.mass), std::max(region.moment, before.moment)};
    }
  }

  Corners<Dim> corners_;
  const std::vector<Species>& species_;
  const Fractions& phi_;
  const Interfaces<Dim>& interfaces_;
  double negligible_ = std::numeric_limits<double>::infinity();
};

/// Weight of the low node of an even edge along d.
template <int Dim>
double even_lever(const Grid<Dim>& grid, const Index<Dim>& i, int d) {
  return grid.line_element(d, i[d]).fraction[0];
}

template <int Dim>
void find_levers(const Domain<Dim>& domain, const std::vector<Species>& species, const Fractions& phi,
                 const Interfaces<Dim>& interfaces, PressureElements<Dim>& elements) {
  const Grid<Dim>& grid = domain.grid;
  const Layout<Dim>& layout = domain.layout();
  const Edges<Dim> edges(domain, species, phi, interfaces);
  const Corners<Dim> corners(layout);
  for_each<Cell>(layout, grow(grid.cells(), 1), [&](Cell c) {
    bool cut = false;
    for (const Surface<Dim>& surface : interfaces) cut = cut || surface.has(c);
    elements.cut[c] = cut ? 1 : 0;
  });
  // An edge along d begins at every node but those on the high side.
  const auto begins = [&](const Index<Dim>& i, int d) { return i[d] < grid.owned_cells()[d]; };
  const auto candidate = [&](Node n, const Index<Dim>& i) {
    bool any = false;
    for (int d = 0; d < Dim; ++d) any = any || (begins(i, d) && edges.at_cut(elements.cut, n, d));
    return any;
  };
  elements.lever.find(layout, grid.nodes(), candidate, [&](Node n, const Index<Dim>& i, Vec<Dim>& lever) {
    bool cut = false;
    for (int d = 0; d < Dim; ++d) {
      const double even = even_lever(grid, i, d);
      lever[d] = begins(i, d) && edges.at_cut(elements.cut, n, d) ? edges.lever(n, d, even) : even;
      cut = cut || lever[d] != even;
    }
    return cut;
  });
  elements.lever.wrap(layout, grid.nodes());
  for_each<Cell>(layout, grid.cells(), [&](Cell c, const Index<Dim>& i) {
    bool cut = false;
    for (int k = 0; k < Corners<Dim>::count; ++k) {
      const Node n = low_node(c) + corners.step[k];
      if (!elements.lever.has(n)) continue;
      for (int d = 0; d < Dim; ++d) {
        if (Corners<Dim>::bit(k, d) == 0) cut = cut || elements.lever[n][d] != even_lever(grid, i, d);
      }
    }
    elements.cut[c] = cut ? 1 : 0;
  });
}

/// Mean over a cell's face normal to d of the shape function of corner k: product of the levers along the edges that
/// meet in k.
template <int Dim>
double face_share(const PressureElements<Dim>& elements, const Grid<Dim>& grid, const Corners<Dim>& corners, Cell c,
                  const Index<Dim>& i, int k, int d) {
  double share = 1;
  for (int e = 0; e < Dim; ++e) {
    if (e == d) continue;
    const int high = Corners<Dim>::bit(k, e);
    const Node low_end = low_node(c) + corners.step[k - (high << e)];
    const double low_share = elements.lever.has(low_end) ? elements.lever[low_end][e] : even_lever(grid, i, e);
    share *= high == 1 ? 1 - low_share : low_share;
  }
  return share;
}

template <int Dim>
void mark_free_nodes(const Domain<Dim>& domain, const CellMask& bears, NodeMask& free) {
  const Corners<Dim> corners(domain.layout());
  for_each<Node>(domain.layout(), domain.grid.nodes(), [&](Node n) {
    bool all = true;
    for (int k = 0; k < Corners<Dim>::count; ++k) {
      const Cell c = high_cell(n) - corners.step[k];
      all = all && bears[c] && domain.beyond[c] != Beyond::open;
    }
    free[n] = all ? 1 : 0;
  });
  wrap(domain.layout(), domain.grid.nodes(), free);
}

}  // namespace

template <int Dim>
MeanGradient<Dim> even_gradient(const Grid<Dim>& grid, const Index<Dim>& i) {
  using C = Corners<Dim>;
  MeanGradient<Dim> g;
  for (int k = 0; k < C::count; ++k) {
    for (int d = 0; d < Dim; ++d) {
      g.at[k][d] = (C::bit(k, d) ? 1 : -1) / grid.width_1d(d, i[d]);
      for (int e = 0; e < Dim; ++e) {
        if (e != d) g.at[k][d] *= grid.line_element(e, i[e]).fraction[C::bit(k, e)];
      }
    }
  }
  return g;
}

template <int Dim>
MeanGradient<Dim> PressureElements<Dim>::gradient(const Grid<Dim>& grid, const Corners<Dim>& corners, Cell c,
                                                  const Index<Dim>& i) const {
  using C = Corners<Dim>;
  if (!cut[c]) return even_gradient(grid, i);
  MeanGradient<Dim> g;
  for (int d = 0; d < Dim; ++d) {
    double of_face[2] = {};  // products of differing levers do not add up to 1 by themselves
    for (int k = 0; k < C::count; ++k) {
      g.at[k][d] = face_share(*this, grid, corners, c, i, k, d);
      of_face[C::bit(k, d)] += g.at[k][d];
    }
    for (int k = 0; k < C::count; ++k) {
      const int side = C::bit(k, d);
      g.at[k][d] *= (side == 1 ? 1 : -1) / (of_face[side] * grid.width_1d(d, i[d]));
    }
  }
  return g;
}

template <int Dim>
void mark_bearing_cells(const Grid<Dim>& grid, const CellField& total, CellMask& bears) {
  mark_liquid(grid, total, 1 - pressureless_fraction, bears);
}

template <int Dim>
void find_pressure_elements(const Domain<Dim>& domain, const std::vector<Species>& species, const Fractions& phi,
                            const CellField& total, const Interfaces<Dim>& interfaces,
                            PressureElements<Dim>& elements) {
  const Corners<Dim> corners(domain.layout());
  find_levers(domain, species, phi, interfaces, elements);
  wrap(domain.layout(), domain.grid.cells(), elements.bears);
  mark_free_nodes(domain, elements.bears, elements.free);
  for_each<Cell>(domain.layout(), domain.grid.cells(), [&](Cell c) {
    if (total[c] >= gap_fraction || !elements.bears[c]) return;
    bool enclosed = true;
    for (int k = 0; k < Corners<Dim>::count; ++k) enclosed = enclosed && elements.free[low_node(c) + corners.step[k]];
    if (enclosed) elements.bears[c] = 0;
  });
  wrap(domain.layout(), domain.grid.cells(), elements.bears);
  mark_free_nodes(domain, elements.bears, elements.free);
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                        \
  template struct PressureElements<Dim>;                                                                  \
  template MeanGradient<Dim> even_gradient(const Grid<Dim>&, const Index<Dim>&);                          \
  template void mark_bearing_cells(const Grid<Dim>&, const CellField&, CellMask&);                        \
  template void find_pressure_elements(const Domain<Dim>&, const std::vector<Species>&, const Fractions&, \
                                       const CellField&, const Interfaces<Dim>&, PressureElements<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
