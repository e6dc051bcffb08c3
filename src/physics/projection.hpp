#pragma once
/// \file
/// Pressure projection (50)-(52) with bilinear (trilinear) pressure on the nodes.
///
/// The pressure is continuous and linear along each axis in a cell, its gradient in a cell is the element mean, and the
/// divergence at a node is the adjoint. With exactly integrated stiffness this approximate projection (Almgren, Bell
/// and Szymczak 1996) never raises the kinetic energy when the gas pressure is uniform.
#include "core/domain.hpp"
#include "solvers/linear_solver.hpp"

namespace quicksand {

/// Work arrays of the projection.
template <int Dim>
struct ProjectionWork {
  StencilMatrix<Dim, Node> matrix;
  NodeMask free;
  NodeField rhs;
  NodeField increment;  ///< pressure above the least one given outside D

  explicit ProjectionWork(const Layout<Dim>& layout)
      : matrix(layout, Stencil::box), free(layout), rhs(layout), increment(layout) {}
};

/// u += factor dt / rho grad P in the cells of D: factor -1 applies a pressure gradient, +1 takes it back.
template <int Dim>
void add_pressure_gradient(const Domain<Dim>& domain, const NodeField& pressure, const CellField& rho,
                           const CellMask& liquid, double factor_dt, CellVectors<Dim>& u);

/// Sets a pressure to that of the gas on the nodes that touch a cell outside D.
template <int Dim>
void apply_outer_pressure(const Domain<Dim>& domain, const CellMask& liquid, const NodeField& outer_pressure,
                          ProjectionWork<Dim>& work, NodeField& pressure);

/// Solves dt div(1/rho grad P) = div u-bar* in D (51), with P = outer_pressure on nodes that touch a cell outside D.
///
/// The equation is linear: with u* in place of u-bar*, which holds the lagged pressure gradient, and no outer pressure
/// it gives the change of P. \param u_bar_star      (52), owned cells \param outer_pressure  pressure of the gas around
/// each node \param pressure        first guess on entry, P on return; outer_pressure outside D \throws NumericalError
/// when the solve does not converge
template <int Dim>
SolveReport solve_pressure(const Domain<Dim>& domain, const CellVectors<Dim>& u_bar_star, const CellField& rho,
                           const CellMask& liquid, const NodeField& outer_pressure, double dt,
                           const SolveOptions& options, ProjectionWork<Dim>& work, NodeField& pressure);

}  // namespace quicksand
