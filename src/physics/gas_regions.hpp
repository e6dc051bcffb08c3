#pragma once
/// \file
/// Gas regions and their pressure: bubbles of adiabatic gas, P = C V^-gamma, and the open air.
///
/// Gas has no equations of motion; its pressure is uniform in every connected region (report, after (20)). The open air
/// has the ambient pressure. A bubble keeps its gas, which is followed from step to step through the events below.
#include <string_view>
#include <vector>

#include "physics/gas_labels.hpp"

namespace quicksand {

/// Region id of the open air and of all other gas at the ambient pressure; bubbles have greater ones.
inline constexpr int open_air = 1;

/// What becomes of ambient gas that liquid encloses.
struct TrappedGas {
  bool adiabatic = false;  ///< it becomes a bubble; else it keeps the ambient pressure
  double exponent = 1.4;   ///< gamma of ambient gas
};

struct GasParameters {
  double ambient_pressure = 0;
  double liquid_threshold = 0.5;  ///< eps of D
  TrappedGas trapped;
};

/// A bubble. Volume and amount are those of the modelled part, per radian in axisymmetric flows.
struct Bubble {
  int id = 0;
  double amount = 0;  ///< of gas: P V at birth, proportional to the number of molecules if all gas is born equally warm
  double exponent = 1.4;     ///< gamma
  double constant = 0;       ///< C of P = C V^-gamma; 0 until the volume is first measured, then from `pressure`
  double volume = 0;         ///< V
  double pressure = 0;       ///< P of the volume
  double mean_pressure = 0;  ///< average over the last step's change of volume: the work it did is that, times it
  double growth = 0;         ///< dV/dt over the last step
};

/// The state of all gas: what a step starts from.
struct GasState {
  CellLabels region;            ///< id of the region of each gas cell, 0 in liquid and without bubbles; see label_gas()
  std::vector<Bubble> bubbles;  ///< by increasing id
  std::vector<Cell> held_open;  ///< the emptiest cell of every bubble: it counts as empty, however full it is
  int last_id = open_air;

  GasState() = default;
  template <int Dim>
  explicit GasState(const Layout<Dim>& layout) : region(layout) {}
  /// No bubble is left, and no region needs to be told from others; new bubbles get ids after last.
  void end(int last) {
    region.fill(0);
    bubbles.clear();
    held_open.clear();
    last_id = last;
  }
};

enum class GasEventKind { born, split, merged, vented, closed, absorbed, lost };
std::string_view name(GasEventKind kind);

/// A change of the regions in a step.
struct GasEvent {
  GasEventKind kind;
  int bubble;           ///< the one it happened to
  int other = 0;        ///< split: the part that got an id of its own; merged, absorbed: the bubble that took the gas
  double volume = 0;    ///< of the gas that changed hands, before the step; born, closed: after it
  double pressure = 0;  ///< of that gas

  friend bool operator==(const GasEvent&, const GasEvent&) = default;
};

/// Gas that takes part in a region after a step.
struct GasPortion {
  double amount;
  double exponent;
  double volume;  ///< before the step
  double pressure;
};

/// Portions joined at the sum of their volumes: amounts and internal energies P V / (gamma - 1) add up, and so do
/// amount / (gamma - 1), the heat capacities. Returns a bubble with id 0.
Bubble join(const std::vector<GasPortion>& portions);

/// Changes a bubble's volume by the adiabatic law; sets pressure and mean pressure.
void change_volume(Bubble& bubble, double volume);

/// Whether any gas can have another pressure than the ambient one.
bool has_bubbles(const GasParameters& parameters, const GasState& gas);

/// Measures the bubbles of a state whose regions were set cell by cell: volumes, and the constants of those that have
/// none yet. \throws InputError if a bubble is not enclosed by liquid, or none of its cells is outside D
template <int Dim>
void start_gas(const Domain<Dim>& domain, const GasParameters& parameters, const CellField& total, GasLabels& labels,
               GasState& gas);

/// The gas after a step that has changed the fractions.
///
/// Regions are labelled anew (label_gas) and matched with those before by the cells they share, weighted by the gas in
/// them. A bubble's gas is divided among the regions that hold it by volume, so that all parts keep its pressure. Where
/// a region holds gas of several, their amounts and internal energies before the step add up (join()), and the mixture
/// then changes its volume by the adiabatic law. In a region that touches an open side all gas takes the ambient
/// pressure, and what was in it is lost. Ambient gas that is enclosed keeps the ambient pressure, or becomes a bubble
/// if so chosen; where it meets a bubble it joins it with its own volume at the ambient pressure.
///
/// A bubble all of whose cells are part-filled lives on: the emptiest of them counts as empty (`held_open`), so that
/// its pressure acts on the liquid. Part-filled cells apart from the rest of their region stay with it. When every cell
/// of a bubble is more than half full it ends: its gas goes to the region that the rest of its volume counts for.
/// \param before, total_before  gas and sum phi before the step
/// \param total                 sum phi after it
/// \param after                 result
/// \returns what happened, by increasing id
template <int Dim>
std::vector<GasEvent> advance_gas(const Domain<Dim>& domain, const GasParameters& parameters, const GasState& before,
                                  const CellField& total_before, const CellField& total, double dt, GasLabels& labels,
                                  GasState& after);

/// Takes the cells that bubbles hold open out of D, or out of the cells that bear pressure.
template <int Dim>
void hold_open(const Grid<Dim>& grid, const GasState& gas, CellMask& liquid);

/// Pressure of the gas around each node: the mean over the cells outside D that touch it, so of two regions' where it
/// touches both; the ambient pressure inside D. \param mean  whether of the last step's change of volume (for the
/// projection), else the present one
template <int Dim>
void gas_pressure_on_nodes(const Domain<Dim>& domain, const GasParameters& parameters, const GasState& gas,
                           const CellMask& liquid, bool mean, NodeField& nodes);

}  // namespace quicksand
