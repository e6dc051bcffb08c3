#pragma once
/// \file
/// The elements that carry stress: where, of which law, and for how much liquid.
#include <vector>

#include "core/domain.hpp"
#include "physics/dual_element.hpp"
#include "physics/mixture.hpp"

namespace quicksand {

/// An element carries stress only if all its corner cells hold more liquid. Thinner films at the surface of a body at
/// rest would otherwise run down it in free fall; with 0.01 they carried off 0.4 % of slug F by t = 2.
inline constexpr double stressless_fraction = 1e-3;

/// One entry per node of the grid, that is, per element of the dual mesh.
template <int Dim>
struct StressElements {
  DualMesh<Dim> mesh;
  NodeMask active;                 ///< carries stress
  Field<Node, Rheology> rheology;  ///< of active elements; of size 0 where no law is more than Newtonian
  NodeField viscosity;             ///< of active elements, where no law is more than Newtonian, else of size 0
  NodeField share;                 ///< liquid an active element stands for, as a part of its volume

  explicit StressElements(const Domain<Dim>& domain) : mesh(domain) {}
  /// Makes the fields, where they are not there; gives them back.
  /// \param newtonian  whether no law is more than that
  void acquire(const Layout<Dim>& layout, bool newtonian);
  void release();
  bool newtonian() const { return viscosity.size() > 0; }
  /// Of an active element.
  Rheology material(Node n) const { return newtonian() ? Rheology{.viscosity = viscosity[n]} : rheology[n]; }
};

/// The factor of (43b): (exp(kappa c) - 1) / (exp(kappa) - 1), c for kappa = 0.
double concentration_factor(double kappa, double c);

/// Finds the active elements, in fields that it acquires, their rheology and their shares for the given fractions.
///
/// The law of an element follows from the mean composition c_i = phi_i / sum phi of its corner cells: the stresses of
/// all species at the common strain rate add up, with viscosities, consistencies and yield stresses each times (43b).
/// Of several species with laws of one kind the exponents (alpha, n) are means: alpha weighted by yield stress, n by
/// consistency. Elements with
/// an (almost) empty corner, or whose law is inviscid, are inactive: their velocity gradient would mean nothing. The
/// liquid in them is shared out among the active elements around them, so that the shares add up to the liquid's volume
/// and a body keeps its strength up to its surface. \returns whether any element is active
template <int Dim>
bool mark_stress_elements(const Domain<Dim>& domain, const std::vector<Species>& species, const Fractions& phi,
                          const CellField& total, StressElements<Dim>& elements);

}  // namespace quicksand
