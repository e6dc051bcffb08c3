#pragma once
/// \file
/// Projection of the predicted face velocities onto divergence-free fields in D.
///
/// Deviates from the report, which convects with the predicted velocities as they are: with projected ones the fraction
/// sum stays 1 inside D, so that gas bubbles don't leak and the redistribution has work at surfaces only.
#include "core/domain.hpp"
#include "solvers/linear_solver.hpp"

namespace quicksand {

/// The potential of the last step, the next one's first guess.
template <int Dim>
struct MacProjectionWork {
  CellField potential;

  explicit MacProjectionWork(const Layout<Dim>& layout) : potential(layout) {}
};

/// Solves div(1/rho grad q) = div u_mac in D with q = 0 on the border of D, and corrects u_mac on the faces of D.
///
/// q is half a time step times a pressure. The coefficient at a face is 1/(rho_L h_L + rho_R h_R) with half widths h;
/// between D and gas only the liquid side counts, so that q = 0 sits on the face.
/// \param u_mac  normal velocities on the faces of owned cells, zero on closed sides
/// \throws NumericalError when the solve does not converge
template <int Dim>
SolveReport project_face_velocities(const Domain<Dim>& domain, const CellField& rho, const CellMask& liquid,
                                    const SolveOptions& options, MacProjectionWork<Dim>& work, FaceScalars<Dim>& u_mac);

}  // namespace quicksand
