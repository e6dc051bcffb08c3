#pragma once
/// \file
/// Pressure projection (50)-(52) with bilinear (trilinear) pressure on the nodes.
///
/// The pressure is continuous and linear along each axis in a cell, its gradient in a cell is the element mean, and the
/// divergence at a node is the adjoint. With exactly integrated stiffness this approximate projection (Almgren, Bell
/// and Szymczak 1996) never raises the kinetic energy when the gas pressure is uniform.
#include "core/domain.hpp"
#include "physics/pressure_elements.hpp"
#include "solvers/linear_solver.hpp"

namespace quicksand {

/// Work arrays of the projection.
template <int Dim>
struct ProjectionWork {
  NodeField rhs;
  NodeField increment;  ///< pressure above the least one given outside D

  explicit ProjectionWork(const Layout<Dim>& layout) : rhs(layout), increment(layout) {}
};

/// u += factor dt / rho grad P in the cells that bear pressure: factor -1 applies a pressure gradient, +1 takes it
/// back.
template <int Dim>
void add_pressure_gradient(const Domain<Dim>& domain, const NodeField& pressure, const CellField& rho,
                           const PressureElements<Dim>& elements, double factor_dt, CellVectors<Dim>& u);

/// Pressures of open sides on their nodes; other nodes stay as they are.
template <int Dim>
void set_open_pressures(const Domain<Dim>& domain, NodeField& outer_pressure);

/// What solve_pressure() makes divergence-free: on inflow sides a velocity has their normal velocity, an acceleration
/// none.
enum class Projected { velocity, acceleration };

/// Solves dt div(1/rho grad P) = div u-bar* in D (51), with P given on nodes that are not free.
///
/// Deviates from the report: the matrix K holds more than the divergence of the elements' mean gradients. This surplus
/// may act on P - memory P^{n-1/2} in place of P: with memory = 1 a pressure that balances all other forces is found
/// again, and what is at rest stays so. Kinetic energy may then rise by more than gas_work(), by as much as the surplus
/// of P^{n-1/2}; with memory = 0 it can't, but for what an inflow brings.
///
/// \param u_bar_star      (52), owned cells
/// \param pressure        on free nodes the last step's pressure on entry (first guess), P^{n+1/2} on return; on the
///                        others what is given
/// \throws NumericalError when the solve does not converge
template <int Dim>
SolveReport solve_pressure(const Domain<Dim>& domain, Projected what, double memory, const CellVectors<Dim>& u_bar_star,
                           const CellField& rho, const PressureElements<Dim>& elements, double dt,
                           const SolveOptions& options, ProjectionWork<Dim>& work, NodeField& pressure);

/// Work that the gas does on the liquid in the projection just solved: minus dt times the sum over the given nodes of
/// their pressure times the volume that leaves D there, r = sum V u-bar* . grad N - dt K P. \param work  as
/// solve_pressure() left it
template <int Dim>
double gas_work(const Domain<Dim>& domain, const CellVectors<Dim>& u_bar_star, const CellField& rho,
                const PressureElements<Dim>& elements, double dt, ProjectionWork<Dim>& work);

}  // namespace quicksand
