/// \file
/// What a flow hands over to another that goes on in its place.
#include <algorithm>

#include "core/archive.hpp"
#include "physics/flow.hpp"

namespace quicksand {

namespace {

template <int Dim>
void carry(Archive& archive, State<Dim>& state) {
  carry(archive, "flow/time", state.time);
  carry(archive, "flow/step", state.step);
  carry(archive, "flow/dt", state.dt);
  carry(archive, "flow/fraction", state.phi);
  carry(archive, "flow/velocity", state.u);
  carry(archive, "flow/pressure", state.pressure);
  carry(archive, "flow/acceleration", state.acceleration);
}

/// Refuses numbers of cells and bubbles that are none.
void check(const Archive& archive, GasState& gas) {
  const auto& region = gas.region.values();
  const auto cells = static_cast<std::ptrdiff_t>(region.size());
  for (const Cell c : gas.held_open) {
    if (c.n < 0 || c.n >= cells) archive.refuse("gas/held_open", "a cell that the grid does not have");
  }
  const bool known = std::all_of(region.begin(), region.end(), [&](int id) {
    return id == 0 || id == open_air ||
           std::any_of(gas.bubbles.begin(), gas.bubbles.end(), [&](const Bubble& bubble) { return bubble.id == id; });
  });
  if (!known) archive.refuse("gas/region", "a bubble that is not among those of the flow");
}

void carry(Archive& archive, GasState& gas) {
  carry(archive, "gas/region", gas.region);
  carry(archive, "gas/last_id", gas.last_id);
  carry(archive, "gas/held_open", gas.held_open, &Cell::n);
  carry(archive, "gas/bubble/id", gas.bubbles, &Bubble::id);
  carry(archive, "gas/bubble/amount", gas.bubbles, &Bubble::amount);
  carry(archive, "gas/bubble/exponent", gas.bubbles, &Bubble::exponent);
  carry(archive, "gas/bubble/constant", gas.bubbles, &Bubble::constant);
  carry(archive, "gas/bubble/volume", gas.bubbles, &Bubble::volume);
  carry(archive, "gas/bubble/pressure", gas.bubbles, &Bubble::pressure);
  carry(archive, "gas/bubble/mean_pressure", gas.bubbles, &Bubble::mean_pressure);
  carry(archive, "gas/bubble/growth", gas.bubbles, &Bubble::growth);
  if (archive.loading()) check(archive, gas);
}

}  // namespace

template <int Dim>
void Flow<Dim>::exchange(Archive& archive) {
  carry(archive, state_);
  carry(archive, state_.gas);
  carry_numbers(archive, "flow/escaped", escaped_);
  // Where the solves of a step start from.
  carry(archive, "guess/mac_potential", mac_potential_);
  carry(archive, "guess/redistribution", redistribution_.H_species);
  carry(archive, "guess/plastic_stress", diffusion_.stress);
  carry(archive, "guess/multiplier", diffusion_.multiplier);
  carry(archive, "guess/penalty", diffusion_.penalty);
  if (archive.loading()) resume(escaped_);
  carry(archive, "flow/energy_scale", energy_scale_);  // of the whole run, which resume() begins anew
}

template void Flow<2>::exchange(Archive&);
template void Flow<3>::exchange(Archive&);

}  // namespace quicksand
