#include "physics/stress_elements.hpp"

#include <algorithm>
#include <cmath>

namespace quicksand {

namespace {

/// Law of an element from the composition of its corners.
template <int Dim>
Rheology mix(const DualElement<Dim>& e, const std::vector<Species>& species, const std::vector<Rheology>& pure,
             const Fractions& phi, double total) {
  RheologySum mixed;
  for (std::size_t s = 0; s < species.size(); ++s) {
    double part = 0;
    for (const Cell c : e.corner) part += phi[s][c];
    const double composition = std::clamp(part / total, 0.0, 1.0);
    const Concentration& k = species[s].concentration;
    mixed.add(pure[s], concentration_factor(k.viscosity_exponent, composition),
              concentration_factor(k.yield_exponent, composition));
  }
  return mixed.result();
}

/// Calls body(neighbour) for the up to 3^Dim - 1 elements around node i that belong to the domain, not counting the
/// node itself where it is its own neighbour.
template <int Dim, class Body>
void for_each_neighbour(const Grid<Dim>& grid, const Index<Dim>& i, Body&& body) {
  constexpr int block = Dim == 2 ? 9 : 27;
  const Box<Dim> nodes = grid.nodes();
  for (int k = 0; k < block; ++k) {
    Index<Dim> j = i;
    for (int d = 0, rest = k; d < Dim; ++d, rest /= 3) j[d] += rest % 3 - 1;
    j = grid.layout().image(j);
    if (nodes.contains(j) && !(j == i)) body(low_node(grid.cell(j)));
  }
}

}  // namespace

double concentration_factor(double kappa, double c) {
  return std::abs(kappa) < 1e-12 ? c : std::expm1(kappa * c) / std::expm1(kappa);
}

template <int Dim>
void StressElements<Dim>::acquire(const Layout<Dim>& layout, bool newtonian) {
  if (share.size() > 0) return;
  active = NodeMask(layout);
  if (newtonian) {
    viscosity = NodeField(layout);
  } else {
    rheology = Field<Node, Rheology>(layout);
  }
  share = NodeField(layout);
}

template <int Dim>
void StressElements<Dim>::release() {
  active = {};
  rheology = {};
  viscosity = {};
  share = {};
}

template <int Dim>
bool mark_stress_elements(const Domain<Dim>& domain, const std::vector<Species>& species, const Fractions& phi,
                          const CellField& total, StressElements<Dim>& elements) {
  std::vector<Rheology> pure;
  for (const Species& s : species) pure.push_back(rheology(s.law));
  if (std::none_of(pure.begin(), pure.end(), [](const Rheology& r) { return r.carries_stress(); })) return false;
  elements.acquire(domain.layout(), std::none_of(pure.begin(), pure.end(), [](const Rheology& r) {
                     return r.is_nonlinear() || r.rigid_yield_stress > 0;
                   }));
  elements.active.fill(0);

  const Grid<Dim>& grid = domain.grid;
  const Layout<Dim>& layout = domain.layout();
  NodeField& liquid = elements.share;  // volume of liquid first, then share
  for_each<Node>(layout, grid.nodes(), [&](Node n, const Index<Dim>& i) {
    const DualElement<Dim> e = elements.mesh.element(n, i);
    double whole = 0;
    bool empty = false;
    for (const Cell c : e.corner) {
      whole += total[c];
      empty = empty || total[c] < stressless_fraction;
    }
    liquid[n] = whole / corner_count<Dim> * e.volume();
    if (empty) return;
    const Rheology mixed = mix(e, species, pure, phi, whole);
    if (elements.newtonian()) {
      elements.viscosity[n] = mixed.viscosity;
    } else {
      elements.rheology[n] = mixed;
    }
    elements.active[n] = mixed.carries_stress() ? 1 : 0;
  });
  // An inactive element leaves each active neighbour an equal part of its liquid.
  NodeField part(layout);
  for_each<Node>(layout, grid.nodes(), [&](Node n, const Index<Dim>& i) {
    part[n] = 0;
    if (elements.active[n] || !(liquid[n] > 0)) return;
    int heirs = 0;
    for_each_neighbour(grid, i, [&](Node m) { heirs += elements.active[m]; });
    if (heirs > 0) part[n] = liquid[n] / heirs;
  });
  for_each<Node>(layout, grid.nodes(), [&](Node n, const Index<Dim>& i) {
    if (!elements.active[n]) return;
    for_each_neighbour(grid, i, [&](Node m) { liquid[n] += part[m]; });
    elements.share[n] = liquid[n] / elements.mesh.element(n, i).volume();
  });
  wrap(layout, grid.nodes(), elements.active);
  return sum<Node>(layout, grid.nodes(), [&](Node n) { return elements.active[n] ? 1.0 : 0.0; }) > 0;
}

template struct StressElements<2>;
template struct StressElements<3>;
template bool mark_stress_elements(const Domain<2>&, const std::vector<Species>&, const Fractions&, const CellField&,
                                   StressElements<2>&);
template bool mark_stress_elements(const Domain<3>&, const std::vector<Species>&, const Fractions&, const CellField&,
                                   StressElements<3>&);

}  // namespace quicksand
