#pragma once
/// \file
/// Projection of the predicted face velocities onto divergence-free fields in D.
///
/// Deviates from the report, which convects with the predicted velocities as they are: with projected ones the fraction
/// sum stays 1 inside D, so that gas bubbles don't leak and the redistribution has work at surfaces only.
#include "core/domain.hpp"
#include "solvers/linear_solver.hpp"

namespace quicksand {

/// Volume per time that has to flow into cells inside the liquid, all 3^Dim - 1 cells around them in D, to fill half of
/// what they lack within the step, where that is a small part of a cell. Planes that turn leave such voids of a few per
/// cent behind a moving surface; they would go with the liquid for good, and where gas accelerates liquid grow into
/// fingers. Zero everywhere if there is nothing from where liquid could come: no cell outside D and no open side.
/// \param total, liquid  sum phi and D, one ghost layer
/// \returns              of owned cells
template <int Dim>
CellField find_voids(const Domain<Dim>& domain, const CellField& total, const CellMask& liquid, double dt);

/// Solves div(1/rho grad q) = div u_mac + inflow / V in D with q = 0 on the border of D, and corrects u_mac on the
/// faces of D.
///
/// q is half a time step times a pressure. The coefficient at a face is 1/(rho_L h_L + rho_R h_R) with half widths h;
/// between D and gas only the liquid side counts, so that q = 0 sits on the face.
/// \param inflow     find_voids(): volume per time that is to stay in a cell, owned cells
/// \param potential  q of the last step (first guess) on entry, of this one on return
/// \param u_mac      normal velocities on the faces of owned cells, zero on closed sides
/// \throws NumericalError when the solve does not converge
template <int Dim>
SolveReport project_face_velocities(const Domain<Dim>& domain, const CellField& rho, const CellMask& liquid,
                                    CellField inflow, const SolveOptions& options, CellField& potential,
                                    FaceScalars<Dim>& u_mac);

}  // namespace quicksand
