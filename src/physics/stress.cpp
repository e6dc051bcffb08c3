#include "physics/stress.hpp"

#include <algorithm>
#include <cmath>

namespace quicksand {

namespace {

/// A regularised law reaches the yield stress nowhere; within a per cent of it the material counts as yielded.
constexpr double yielding_share = 0.99;

/// A viscous stress below this part of a rigid yield stress is the error of a plug's rigidity.
constexpr double plug_share = 1e-4;

}  // namespace

template <int Dim>
StressFields evaluate_stress(const Flow<Dim>& flow) {
  const Grid<Dim>& grid = flow.domain().grid;
  StressElements<Dim> elements(flow.domain());
  StressFields fields{CellField(grid.layout()), CellField(grid.layout()), CellField(grid.layout())};
  if (!mark_stress_elements(flow.domain(), flow.parameters().species, flow.state().phi, flow.total(), elements)) {
    return fields;
  }
  CellField weights(grid.layout());
  for_each_coloured<Node>(grid.layout(), grid.nodes(), [&](Node n, const Index<Dim>& index) {
    if (!elements.active[n]) return;
    const DualElement<Dim> e = elements.mesh.element(n, index);
    double corner[corner_count<Dim>][Dim];
    gather(e, flow.state().u, corner);
    StrainRate<Dim> rates[point_count<Dim>];
    strain_rates(e, corner, rates);
    const Rheology rheology = elements.material(n);
    double sums[corner_count<Dim>][4] = {};
    for (int q = 0; q < point_count<Dim>; ++q) {
      if (!(e.weight(q) > 0)) continue;
      const StrainRate<Dim>& s = rates[q];
      double f = effective_viscosity(rheology, s.scalar);
      double magnitude = f * s.scalar;
      bool unyielded = magnitude < yielding_share * rheology.regularised_yield_stress();
      if (rheology.rigid_yield_stress > 0) {
        const StrainRate<Dim>& rigid = flow.rigid_stress()[n].at[q];
        const double size = std::sqrt(inner(rigid, rigid));
        magnitude = add_scaled(rigid, f, s).scalar;
        // In a plug that moves the solver may leave the stress at the yield stress.
        const bool creeps = f > 0 && f * s.scalar < plug_share * rheology.rigid_yield_stress;
        unyielded = creeps || is_rigid(rigid, rheology.rigid_yield_stress);
        f += std::min(size / std::max(s.scalar, 1e-300), flow.rigid_viscosity());
      }
      const double values[4] = {1, f, magnitude, unyielded ? 1.0 : 0.0};
      for (int k = 0; k < corner_count<Dim>; ++k) {
        const double share = e.weight(q) * mid_edge_shapes<Dim>.value[q][k];
        for (int v = 0; v < 4; ++v) sums[k][v] += share * values[v];
      }
    }
    for (int k = 0; k < corner_count<Dim>; ++k) {
      const Cell c = e.corner[k];
      weights[c] += sums[k][0];
      fields.viscosity[c] += sums[k][1];
      fields.magnitude[c] += sums[k][2];
      fields.unyielded[c] += sums[k][3];
    }
  });
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c) {
    const double scale = weights[c] > 0 ? 1 / weights[c] : 0.0;
    fields.viscosity[c] *= scale;
    fields.magnitude[c] *= scale;
    fields.unyielded[c] *= scale;
  });
  return fields;
}

template StressFields evaluate_stress(const Flow<2>&);
template StressFields evaluate_stress(const Flow<3>&);

}  // namespace quicksand
