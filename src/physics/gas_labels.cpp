#include "physics/gas_labels.hpp"

#include <algorithm>

namespace quicksand {

namespace {

/// A gas cell of the last step stays one while it is filled less than this.
constexpr double connecting_fraction = 0.5;

/// Calls body(Cell) for all owned cells, one after the other in the order of their numbers.
template <int Dim, class Body>
void in_order(const Grid<Dim>& grid, Body&& body) {
  const Rows<Dim> rows(grid.layout(), grid.cells());
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    for (int i = 0; i < rows.length; ++i) body(Cell{rows.start(r) + i});
  }
}

/// Calls body(Cell) for the owned cells across the faces of a cell that are not closed, across periodic ends too.
template <int Dim, class Body>
void for_neighbours(const Domain<Dim>& domain, Cell c, Body&& body) {
  const Layout<Dim>& layout = domain.layout();
  const Index<Dim> index = layout.multi(c.n);
  for (int d = 0; d < Dim; ++d) {
    const Step e = domain.grid.step(d);
    for (const int shift : {-1, 1}) {
      const int there = layout.image(d, index[d] + shift);
      if (there < 0 || there >= domain.grid.owned_cells()[d]) continue;
      if (domain.passes(d, shift < 0 ? index : shifted(index, d, 1))) body(c + (there - index[d]) * e);
    }
  }
}

/// Whether a cell has a face on an open side, or on an inflow side that gas comes in through.
template <int Dim>
bool at_open_side(const Domain<Dim>& domain, Cell c) {
  const Index<Dim> index = domain.layout().multi(c.n);
  const auto opens = [&](int d, int s) {
    const Side& side = domain.sides.at(d, s);
    return domain.grid.at_boundary(d, s) && (is_open(side) || (is_passable(side) && !side.outside));
  };
  for (int d = 0; d < Dim; ++d) {
    if (index[d] == 0 && opens(d, 0)) return true;
    if (index[d] + 1 == domain.grid.owned_cells()[d] && opens(d, 1)) return true;
  }
  return false;
}

/// The region that gas cell c was part of in the last step; for a cell that was liquid then the one region around it,
/// corners included, 0 if there is none or more than one.
template <int Dim>
int region_before(const Grid<Dim>& grid, const CellLabels& previous, Cell c) {
  if (previous[c] > 0) return previous[c];
  int found = 0;
  bool unique = true;
  const Index<Dim> index = grid.layout().multi(c.n);
  constexpr int block = Dim == 2 ? 9 : 27;
  for (int k = 0; k < block; ++k) {
    Cell neighbour = c;
    bool inside = true;
    for (int d = 0, rest = k; d < Dim; ++d, rest /= 3) {
      const int there = grid.layout().image(d, index[d] + rest % 3 - 1);
      inside = inside && there >= 0 && there < grid.owned_cells()[d];
      neighbour = neighbour + (there - index[d]) * grid.step(d);
    }
    const int region = inside ? previous[neighbour] : 0;
    if (region == 0) continue;
    unique = unique && (found == 0 || found == region);
    found = region;
  }
  return unique ? found : 0;
}

/// Floods the gas cells component by component, and notes what belongs to each.
template <int Dim>
void flood(const Domain<Dim>& domain, const CellField& total, double threshold, const CellLabels& previous,
           GasLabels& labels) {
  const auto outside = [&](Cell c) { return total[c] < 1 - threshold; };
  const auto is_gas = [&](Cell c) { return outside(c) || (previous[c] > 0 && total[c] < connecting_fraction); };
  in_order(domain.grid, [&](Cell c) {
    labels.component[c] = GasLabels::no_component;
    labels.parent[c] = is_gas(c) ? region_before(domain.grid, previous, c) : 0;
  });
  std::vector<Cell> front;
  in_order(domain.grid, [&](Cell first) {
    if (!is_gas(first) || labels.component[first] != GasLabels::no_component) return;
    const int k = static_cast<int>(labels.components.size());
    GasComponent part{.emptiest = first};
    front.assign(1, first);
    labels.component[first] = k;
    while (!front.empty()) {
      const Cell c = front.back();
      front.pop_back();
      part.open = part.open || at_open_side(domain, c);
      part.outside += outside(c) ? 1 : 0;
      if (total[c] < total[part.emptiest] || (total[c] == total[part.emptiest] && c.n < part.emptiest.n)) {
        part.emptiest = c;
      }
      for_neighbours(domain, c, [&](Cell n) {
        if (!is_gas(n) || labels.component[n] != GasLabels::no_component) return;
        if (!(outside(c) && outside(n)) && labels.parent[c] != labels.parent[n]) return;
        labels.component[n] = k;
        front.push_back(n);
      });
    }
    labels.components.push_back(part);
  });
}

/// Gives every cell's gas to the nearest region, layer by layer, and adds up the volumes.
template <int Dim>
void share_out(const Domain<Dim>& domain, const CellField& total, GasLabels& labels) {
  std::vector<GasComponent>& parts = labels.components;
  std::vector<Cell> layer;
  in_order(domain.grid, [&](Cell c) {
    const int k = labels.component[c];
    labels.owner[c] = k;
    if (k == GasLabels::no_component) return;
    parts[static_cast<std::size_t>(k)].volume += (1 - total[c]) * domain.grid.volume(c);
    layer.push_back(c);
  });
  std::vector<int> neighbours;
  for (bool first = true; !layer.empty(); first = false) {
    std::vector<Cell> next;
    for (const Cell c : layer) {
      for_neighbours(domain, c, [&](Cell n) {
        if (labels.owner[n] != GasLabels::no_component) return;
        labels.owner[n] = labels.owner[c];
        next.push_back(n);
      });
    }
    for (const Cell c : next) {
      const double gas = (1 - total[c]) * domain.grid.volume(c);
      neighbours.clear();
      if (first) {
        for_neighbours(domain, c, [&](Cell n) {
          const int k = labels.component[n];
          if (k == GasLabels::no_component || std::find(neighbours.begin(), neighbours.end(), k) != neighbours.end()) {
            return;
          }
          neighbours.push_back(k);
        });
      } else {
        neighbours.push_back(labels.owner[c]);
      }
      for (const int k : neighbours) {
        parts[static_cast<std::size_t>(k)].volume += gas / static_cast<double>(neighbours.size());
      }
    }
    layer = std::move(next);
  }
}

}  // namespace

template <int Dim>
void label_gas(const Domain<Dim>& domain, const CellField& total, double threshold, const CellLabels& previous,
               GasLabels& labels) {
  if (labels.component.size() == 0) labels = GasLabels(domain.layout());
  labels.components.clear();
  flood(domain, total, threshold, previous, labels);
  share_out(domain, total, labels);
}

template void label_gas(const Domain<2>&, const CellField&, double, const CellLabels&, GasLabels&);
template void label_gas(const Domain<3>&, const CellField&, double, const CellLabels&, GasLabels&);

}  // namespace quicksand
