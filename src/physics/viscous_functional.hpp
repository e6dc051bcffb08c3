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

/// Value of the functional at u, and its gradient (0 in cells that take no part).
template <int Dim>
double evaluate_functional(const Domain<Dim>& domain, const CellVectors<Dim>& u_hat, const CellVectors<Dim>& u,
                           double dt, DiffusionWork<Dim>& work, CellVectors<Dim>& gradient);

/// Mass plus dt times the linearised stress at u, into work.matrix.
template <int Dim>
void assemble_matrix(const Domain<Dim>& domain, const CellVectors<Dim>& u, double dt, Linearisation linearisation,
                     DiffusionWork<Dim>& work);

/// Plastic stress after a Newton step from u to u - update, linearised about u and kept within the yield stress.
/// Does nothing when no species yields.
template <int Dim>
void update_plastic_stress(const Domain<Dim>& domain, const CellVectors<Dim>& u, const CellVectors<Dim>& update,
                           DiffusionWork<Dim>& work);

}  // namespace quicksand
