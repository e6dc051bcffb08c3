#include "physics/bubble_measures.hpp"

#include <algorithm>

#include "physics/diagnostics.hpp"

namespace quicksand {

template <int Dim>
std::vector<BubbleMeasures<Dim>> measure_bubbles(const Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  const GasState& gas = flow.state().gas;
  const GasLabels& labels = flow.gas_labels();
  const double circle = full_circle(grid);
  std::vector<BubbleMeasures<Dim>> measures;
  for (const Bubble& b : gas.bubbles) {
    BubbleMeasures<Dim> m{b.id, circle * b.volume, b.pressure, {}, 0};
    const auto volume = [&](Cell c) {
      const int k = labels.owner[c];
      const bool owned = k >= 0 && gas.region[labels.components[static_cast<std::size_t>(k)].emptiest] == b.id;
      return owned ? (1 - flow.total()[c]) * grid.volume(c) : 0.0;
    };
    double whole = 0;
    const Rows<Dim> rows(grid.layout(), grid.cells());
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      Index<Dim> index = grid.layout().multi(rows.start(r));
      double length = 0;
      for (int i = 0; i < rows.length; ++i, ++index[0]) {
        const Cell c = grid.cell(index);
        const double part = volume(c);
        whole += part;
        length += part / grid.volume(index) * grid.width_1d(0, index[0]);
        for (int d = 0; d < Dim; ++d) m.centroid[d] += part * grid.centre_position(d, index[d]);
      }
      m.width = std::max(m.width, length);
    }
    for (int d = 0; d < Dim; ++d) m.centroid[d] = whole > 0 ? m.centroid[d] / whole : 0.0;
    if (grid.axisymmetric()) m.centroid[0] = 0;
    measures.push_back(m);
  }
  return measures;
}

template <int Dim>
CellField gas_region_field(const Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  const GasState& gas = flow.state().gas;
  CellField region(grid.layout());
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c) {
    region[c] = flow.liquid()[c] ? 0 : gas.bubbles.empty() ? open_air : gas.region[c];
  });
  return region;
}

template std::vector<BubbleMeasures<2>> measure_bubbles(const Flow<2>&);
template std::vector<BubbleMeasures<3>> measure_bubbles(const Flow<3>&);
template CellField gas_region_field(const Flow<2>&);
template CellField gas_region_field(const Flow<3>&);

}  // namespace quicksand
