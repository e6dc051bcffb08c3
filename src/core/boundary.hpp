#pragma once
/// \file
/// Sides of the domain and the ghost rules that follow from their kind.
///
/// A ghost value is affine in its mirror cell, ghost = alpha * mirror + beta, so that the same rule fills ghost cells
/// and enters a matrix (diagonal += alpha * coefficient, right-hand side -= beta * coefficient).
#include <array>
#include <optional>

#include "core/field.hpp"
#include "core/grid.hpp"
#include "core/periodic.hpp"

namespace quicksand {

/// A periodic side is where the domain goes on at the other end of the axis; ghost cells there are copies by no rule.
enum class SideKind { axis, symmetry, free_slip, no_slip, open, inflow, periodic };

/// How the velocity of an inflow side varies across it.
enum class Profile {
  uniform,
  parabolic,  ///< falls to zero at walls that hold the flow, along every axis of the side
};

/// One side of the domain as the user names it.
struct Side {
  SideKind kind = SideKind::free_slip;
  double pressure = 0;                   ///< outside pressure of an open side
  std::optional<std::size_t> outside{};  ///< species beyond an open or inflow side; none: gas
  Vec<3> velocity{};                     ///< of a no-slip wall along itself, or of an inflow; along the grid's axes
  Profile profile = Profile::uniform;    ///< of an inflow, whose largest velocity is `velocity`
};

/// Low (0) and high (1) side along every axis.
template <int Dim>
struct Sides {
  std::array<std::array<Side, 2>, static_cast<std::size_t>(Dim)> side;
  const Side& at(int d, int s) const { return side[static_cast<std::size_t>(d)][static_cast<std::size_t>(s)]; }
  Side& at(int d, int s) { return side[static_cast<std::size_t>(d)][static_cast<std::size_t>(s)]; }
};

/// The axes with two periodic sides. \throws InputError where only one side of an axis is periodic
template <int Dim>
AxisFlags<Dim> periodic_axes(const Sides<Dim>& sides);

/// ghost = alpha * mirror + beta
struct GhostRule {
  double alpha;
  double beta;
};

/// Whether liquid and momentum can leave through the side.
constexpr bool is_open(const Side& side) { return side.kind == SideKind::open; }
/// Whether something crosses the side, freely or at a given velocity.
constexpr bool is_passable(const Side& side) { return is_open(side) || side.kind == SideKind::inflow; }
/// Volume fraction of a species: mirrored at closed sides; beyond others 1 for the species outside, 0 for all else.
GhostRule fraction_rule(const Side& side, std::size_t species);
/// Velocity in convection and redistribution, where no wall drags: normal component odd and tangential even at closed
/// sides, both continued at open ones, nought at inflow sides, to which their velocity is then added.
GhostRule inviscid_velocity_rule(const Side& side, bool normal);
/// Velocity relative to the side's in the viscous stress: as above, but tangential zero on a no-slip wall, on an open
/// side (report, tube flow) and, like the normal one, on an inflow side.
GhostRule viscous_velocity_rule(const Side& side, bool normal);
/// Potentials whose gradient moves volume (H, MAC pressure increment): flux zero at closed sides, zero on open ones.
GhostRule potential_rule(const Side& side);

/// Fills the ghost cells beyond the domain's boundary and across the ends of periodic axes, corners included; ghost
/// cells at seams between grids are left alone. \param rule  callable (axis, side 0|1) -> GhostRule
template <int Dim, class Rule>
void fill_ghosts(const Grid<Dim>& grid, CellField& field, Rule&& rule) {
  Box<Dim> done = grid.cells();
  for (int d = 0; d < Dim; ++d) {
    if (grid.layout().periodic(d)) wrap_axis(grid.layout(), done, d, ghosts, field);
    for (int s = 0; s < 2; ++s) {
      if (!grid.at_boundary(d, s)) continue;
      const GhostRule r = rule(d, s);
      Box<Dim> layer = done;
      layer.lo[d] = s == 0 ? -ghosts : grid.owned_cells()[d];
      layer.hi[d] = layer.lo[d] + ghosts;
      const Step along = grid.step(d);
      const int mirror_sum = s == 0 ? -1 : 2 * grid.owned_cells()[d] - 1;
      const int last = grid.owned_cells()[d] - 1;
      for_each<Cell>(grid.layout(), layer, [&](Cell c, const Index<Dim>& i) {
        // On an axis of one cell the second ghost mirrors the only cell too.
        const int mirror = std::clamp(mirror_sum - i[d], 0, last);
        field[c] = r.alpha * field[c + (mirror - i[d]) * along] + r.beta;
      });
    }
    // The next axes fill the corners from these ghost cells.
    done.lo[d] -= ghosts;
    done.hi[d] += ghosts;
  }
}

/// Ghost cells of the volume fraction of a species.
template <int Dim>
void fill_fraction_ghosts(const Grid<Dim>& grid, const Sides<Dim>& sides, std::size_t species, CellField& phi) {
  fill_ghosts(grid, phi, [&](int d, int s) { return fraction_rule(sides.at(d, s), species); });
}

/// Ghost cells of an acceleration for convection; see Domain for velocities.
template <int Dim>
void fill_acceleration_ghosts(const Grid<Dim>& grid, const Sides<Dim>& sides, CellVectors<Dim>& a) {
  for (int e = 0; e < Dim; ++e) {
    fill_ghosts(grid, a[e], [&](int d, int s) { return inviscid_velocity_rule(sides.at(d, s), d == e); });
  }
}

}  // namespace quicksand
