#pragma once
/// \file
/// The functional that viscoplastic diffusion minimises, its gradient and its (secant or tangent) matrix.
#include "physics/diffusion.hpp"

namespace quicksand {

/// Which linearisation of the stress a matrix holds.
enum class Linearisation {
  secant,   ///< f(s) frozen: the report's iteration (49)
  tangent,  ///< with f'(s), one of the two strains in f'(s)/s Delta Delta replaced by work.stress / f: primal-dual
            ///< Newton
};

/// The functional at one velocity.
struct FunctionalValue {
  double value;  ///< with the penalised form of rigid yield stresses, see rigid_yield.hpp
  double gap;    ///< dt sum W (tau_y s - <q, Delta>) over rigid yield stresses, q their stresses
};

/// Value of the functional at u, and its gradient (0 in cells that take no part).
///
/// With the gradient r, 1/2 |u - u*|^2 in the norm of the masses is at most gap + 1/2 sum r^2 / m, u* the minimiser of
/// the functional without penalty: the functional is strongly convex, and q is admissible in its dual.
template <int Dim>
FunctionalValue evaluate_functional(const Domain<Dim>& domain, const CellVectors<Dim>& u_hat, const CellVectors<Dim>& u,
                                    double dt, DiffusionWork<Dim>& work, CellVectors<Dim>& gradient);

/// Mass plus dt times the linearised stress at u, into work.matrix.
template <int Dim>
void assemble_matrix(const Domain<Dim>& domain, const CellVectors<Dim>& u, double dt, Linearisation linearisation,
                     DiffusionWork<Dim>& work);

/// y = A v, with A mass plus dt times the stress of laws that are linear (Newtonian): neither strain rates nor matrices
/// are stored.
template <int Dim>
void apply_linear_stress(const Domain<Dim>& domain, const CellVectors<Dim>& v, double dt, DiffusionWork<Dim>& work,
                         CellVectors<Dim>& y);

/// The diagonal of that A, with 1 in cells without mass.
template <int Dim>
void linear_stress_diagonal(const Domain<Dim>& domain, double dt, DiffusionWork<Dim>& work, CellVectors<Dim>& diagonal);

/// Plastic stresses after a Newton step from u to u - update, linearised about u and kept within the yield stress.
/// Does nothing when no species yields.
template <int Dim>
void update_plastic_stress(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellVectors<Dim>& update,
                           DiffusionWork<Dim>& work);

/// Per element the largest step of a gradient method for rigid stresses, a viscosity: 1/lambda + mu, where lambda
/// bounds the element's stiffness at unit viscosity, times dt, against its corners' share of the mass.
template <int Dim>
NodeField dual_steps(const Domain<Dim>& domain, double dt, const DiffusionWork<Dim>& work);

/// The elements that have a corner in a box of cells.
template <int Dim>
Box<Dim> elements_around(const Grid<Dim>& grid, Box<Dim> cells) {
  for (int d = 0; d < Dim; ++d) ++cells.hi[d];
  return intersect(cells, grid.nodes());
}

/// Calls body(node, element, q, Delta) for every stress point with weight, Delta its strain rate at velocities u; in
/// threads over elements.
template <int Dim, class Body>
void for_each_stress_point(const Domain<Dim>& domain, const CellVectors<Dim>& u, DiffusionWork<Dim>& work,
                           Body&& body) {
  const Box<Dim> elements = elements_around(domain.grid, work.matrix.box());
  for_each<Node>(domain.layout(), elements, [&](Node n, const Index<Dim>& index) {
    if (!work.elements.active[n]) return;
    const DualElement<Dim> e = work.elements.mesh.element(n, index);
    double corner[corner_count<Dim>][Dim];
    gather(e, u, corner);
    StrainRate<Dim> rates[point_count<Dim>];
    strain_rates(e, corner, rates);
    for (int q = 0; q < point_count<Dim>; ++q) {
      if (e.weight(q) > 0) body(n, e, q, rates[q]);
    }
  });
}

}  // namespace quicksand
