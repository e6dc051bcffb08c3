#pragma once
/// \file
/// Loops over the elements that carry stress, in packs wherever that is possible.
#include <algorithm>

#include "core/loop.hpp"
#include "physics/stress_elements.hpp"

namespace quicksand {

/// An active element, or a pack of elements of which some are.
template <int Dim, class Real>
struct ActiveElement : DualElement<Dim, Real> {
  using Number = Real;
  Node node;   ///< of the first one
  Real share;  ///< of StressElements; 0 in lanes that take no part
  bool on(int l) const { return lane(share, l) > 0; }
};

/// Calls body(e) for the active elements in [i[0], last) of the row that begins at i, one after the other or in packs.
template <int Dim, class Body>
void for_each_active_in_row(const Layout<Dim>& layout, const StressElements<Dim>& elements, Index<Dim> i, int last,
                            Body&& body) {
  const auto visit = [&]<class Real>(int at, int skipped, Real) {
    i[0] = at;
    const Node n{layout.flat(i)};
    Real share{};
    bool any = false;
    for (int l = skipped; l < lanes<Real>; ++l) {
      if (!elements.active[n + Step{l}]) continue;
      set_lane(share, l, elements.share[n + Step{l}]);
      any = true;
    }
    if (any) body(ActiveElement<Dim, Real>{{elements.mesh.template element<Real>(n, i)}, n, share});
  };
  const int first = i[0];
  const auto [packed, end] = elements.mesh.packed_part(first, last);
  for (int at = first; at < packed; ++at) visit(at, 0, double{});
  for (int at = packed; at < end; at += pack_width) {
    // The last pack begins earlier, where need be, with lanes left out that another has done.
    const int start = std::min(at, end - pack_width);
    visit(start, at - start, Pack{});
  }
  for (int at = end; at < last; ++at) visit(at, 0, double{});
}

/// Calls body(e) for all active elements of a box, whose cells all have finite velocities, in threads such that a body
/// may write to the element's corners.
template <int Dim, class Body>
void for_each_active_element(const Layout<Dim>& layout, const Box<Dim>& box, const StressElements<Dim>& elements,
                             Body&& body) {
  constexpr int cost = Dim == 2 ? 32 : 128;
  for_each_coloured_row(layout, box, cost,
                        [&](const Index<Dim>& row) { for_each_active_in_row(layout, elements, row, box.hi[0], body); });
}

/// The material of an element, or of a pack of elements.
template <int Dim, class Real>
class ElementMaterial {
 public:
  ElementMaterial(const StressElements<Dim>& elements, const ActiveElement<Dim, Real>& e) {
    if (elements.newtonian()) {
      for (int l = 0; l < lanes<Real>; ++l) {
        if (e.on(l)) set_lane(viscosity_, l, elements.viscosity[e.node + Step{l}]);
      }
      return;
    }
    for (int l = 0; l < lanes<Real>; ++l) {
      rheology_[l] = e.on(l) ? &elements.rheology[e.node + Step{l}] : nullptr;
      if (!rheology_[l]) continue;
      set_lane(viscosity_, l, rheology_[l]->viscosity);
      nonlinear_ = nonlinear_ || rheology_[l]->is_nonlinear();
      rigid_ = rigid_ || rigid(l);
    }
  }
  const Real& viscosity() const { return viscosity_; }
  /// Whether the viscosity depends on the strain rate; whether there is a rigid yield stress, and in which lanes.
  bool nonlinear() const { return nonlinear_; }
  bool rigid() const { return rigid_; }
  bool rigid(int l) const { return rheology_[l] != nullptr && rheology_[l]->rigid_yield_stress > 0; }
  /// Calls body(l, evaluate() at scalar strain rates s) for the lanes that take part.
  template <class Body>
  void evaluate_lanes(const Real& s, Body&& body) const {
    for (int l = 0; l < lanes<Real>; ++l) {
      if (rheology_[l]) body(l, evaluate(*rheology_[l], lane(s, l)));
    }
  }

 private:
  const Rheology* rheology_[lanes<Real>] = {};
  Real viscosity_{};
  bool nonlinear_ = false;
  bool rigid_ = false;
};

}  // namespace quicksand
