#pragma once
/// \file
/// The time step: the report's equations strung together.
#include <array>
#include <functional>
#include <string_view>
#include <vector>

#include "core/archive.hpp"
#include "core/domain.hpp"
#include "physics/convection.hpp"
#include "physics/diffusion.hpp"
#include "physics/mac_projection.hpp"
#include "physics/projection.hpp"
#include "physics/redistribution.hpp"
#include "physics/state.hpp"
#include "physics/step_guard.hpp"

namespace quicksand {

/// What stays the same during a run.
template <int Dim>
struct FlowParameters {
  std::vector<Species> species;
  Vec<Dim> gravity;  ///< acceleration vector, downwards along the last axis as a rule
  double ambient_pressure = 0;
  double liquid_threshold = 0.5;            ///< eps of D = {sum phi >= 1 - eps}
  TrappedGas trapped_gas;                   ///< what becomes of ambient gas that liquid encloses
  SolveOptions linear{{.relative = 1e-9}};  ///< both projections
  SolveOptions momentum{{.relative = 1e-13},
                        Method::jacobi};  ///< momentum redistribution; cheap, and energy hangs on it
  ObstacleOptions obstacle;
  DiffusionOptions diffusion;
  GuardSettings guard;
};

enum class Phase { convection, mac_projection, redistribute_volume, redistribute_momentum, diffusion, projection };
inline constexpr std::array<std::string_view, 6> phase_names = {
    "convection", "mac_projection", "redistribute_volume", "redistribute_momentum", "diffusion", "projection"};

/// What became of one step.
struct StepReport {
  std::array<double, phase_names.size()> seconds{};
  SolveReport mac;
  std::vector<ObstacleReport> obstacle;  ///< per species
  SolveReport momentum;
  DiffusionReport diffusion;
  SolveReport projection;
  double redistribution_energy_change = 0;  ///< kinetic energy after less before, (24)-(27) and (11) together
  double liquid_volume = 0;                 ///< of all species in the domain, after the step
  double projection_energy_change = 0;      ///< kinetic energy of u^{n+1} less that of (52)
  double energy_scale = 0;                  ///< what changes of energy are compared with: the largest energy so far
  double momentum_norm = 0;                 ///< sqrt(sum V rho |u^{n+1}|^2)
  double momentum_change = 0;               ///< sqrt(sum V rho |u^{n+1} - u^n|^2) / dt
  double gas_work = 0;                      ///< what gas at different pressures has done in the projection
  std::vector<GasEvent> gas;                ///< what happened to the bubbles
};

/// What the phases of a step in progress hand on, open to whoever watches them.
template <int Dim>
struct StepInProgress {
  int part;  ///< of the step that has ended, from 1: phase by phase, convection being in two with one between
  FaceScalars<Dim>* u_mac;           ///< normal velocities on faces; null once convection is done
  CellVectors<Dim>& momentum_tilde;  ///< after parts 3 and 4; lies where next.u is from part 6 on
  CellVectors<Dim>& u_bar;           ///< after parts 5 to 7; lies in next.acceleration
  State<Dim>& next;  ///< fractions from part 3 on, velocities from 6 on, the pressure after 7; no sizes before
};

/// Called at the end of every phase, twice for convection, which goes on after the MAC projection.
template <int Dim>
using PhaseWatcher = std::function<void(StepInProgress<Dim>)>;

/// A flow on one grid: its state and the work arrays of its phases.
template <int Dim>
class Flow {
 public:
  Flow(Domain<Dim> domain, FlowParameters<Dim> parameters);

  const Domain<Dim>& domain() const { return domain_; }
  const FlowParameters<Dim>& parameters() const { return parameters_; }
  const State<Dim>& state() const { return state_; }
  /// For initial conditions; fractions and velocities of owned cells suffice.
  State<Dim>& state() { return state_; }
  /// Volume of each species that has left through open sides (negative: come in), per radian in axisymmetric flows.
  const std::vector<double>& escaped() const { return escaped_; }
  /// Volume of each species in the domain, plus what has escaped: conserved.
  const std::vector<double>& volume() const { return volume_; }
  /// Fields that follow from the current state's fractions, valid after initialize() or advance(); in a step from the
  /// new ones, once these are there.
  const CellField& total() const { return total_; }
  const CellField& density() const { return rho_; }
  const CellMask& liquid() const { return liquid_; }
  const Interfaces<Dim>& interfaces() const { return interfaces_; }
  /// Regions of gas, where there are bubbles.
  const GasLabels& gas_labels() const { return gas_labels_; }
  GasParameters gas_parameters() const {
    return {parameters_.ambient_pressure, parameters_.liquid_threshold, parameters_.trapped_gas};
  }
  /// Stresses of Bingham's law at the stress points in the last step, and the viscosity that stood for infinity; of
  /// size 0 when no species has that law.
  const Field<Node, PointStresses<Dim>>& rigid_stress() const { return diffusion_.multiplier; }
  double rigid_viscosity() const { return diffusion_.penalty; }

  /// Makes the flow ready to advance after fractions and velocities of state() were set: everything that follows from
  /// the fractions, and the pressure and acceleration under gravity.
  ///
  /// \throws NumericalError when the pressure solve fails
  void initialize();
  /// Makes the flow ready to go on from a state() that was set as a whole, velocities, pressure and gas included.
  /// \param escaped  as escaped()
  void resume(std::vector<double> escaped);
  /// As resume(), in place of a flow on another grid: with its largest energy so far, its watcher and what has escaped.
  void resume_in_place_of(const Flow& other);
  /// Advances by dt. The state is left as it was when this throws NumericalError; after anything else, what follows
  /// from the state (total() and the like) may be that of the step in progress. \throws NumericalError when a solve
  /// fails, a value is not finite, or volume or energy are not kept
  StepReport advance(double dt);
  /// Where the last step failed: what it had come to, and what it started from where it had not come to anything; else
  /// null.
  const State<Dim>* failed_attempt() const { return attempt_failed_ ? &next_ : nullptr; }
  /// Lets the phases of the steps to come be watched, and their results be changed: for looking into a step, and for
  /// tests that spoil one.
  void watch(PhaseWatcher<Dim> watcher) { watcher_ = std::move(watcher); }
  /// Hands over everything that a step starts from, besides domain and parameters: the state, what has escaped, and
  /// what earlier steps left for solves to start from. A flow that takes it from an archive, in place of initialize(),
  /// goes on to the same bits. Work arrays that outlive a step and matter to the next one belong here.
  ///
  /// \throws FileError where the archive's values are those of another grid or other species
  void exchange(Archive& archive);

 private:
  /// Ghost cells, total(), density() and liquid() of the current state.
  void refresh();
  /// total(), density() and liquid() of a state's fractions and gas, ghost cells of the fractions included.
  void find_mixture(State<Dim>& state);
  /// Gives nodes that are not free the pressure of the gas around them, or of their open side.
  /// \param mean  see gas_pressure_on_nodes()
  void set_outer_pressure(const GasState& gas, bool mean, NodeField& pressure) const;
  /// Where pressure acts for a state's fractions and gas, whose total() it is.
  void find_elements(const State<Dim>& state);
  /// (51), (50): the pressure of the new state, and its velocity from (52) in place.
  void project(double dt, StepReport& report);
  /// The step itself: writes next_, then makes it the state.
  StepReport step(double dt);
  /// Completes failed_attempt(), and clears or restores the mixture, elements and work arrays that outlive a step.
  void leave_failed_step(double dt);

  Domain<Dim> domain_;
  FlowParameters<Dim> parameters_;
  State<Dim> state_, next_;
  std::vector<double> escaped_;
  std::vector<double> volume_;
  double energy_scale_ = 0;  ///< the largest energy so far
  CellField total_, rho_;
  CellMask liquid_;
  Interfaces<Dim> interfaces_;
  PressureElements<Dim> elements_;
  CellVectors<Dim> u_hat_;
  CellField mac_potential_;  ///< of the MAC projection, its next first guess
  RedistributionWork<Dim> redistribution_;
  DiffusionWork<Dim> diffusion_;
  GasLabels gas_labels_;
  /// Stresses of Bingham's law at the start of a step, for when it fails: they belong to the results.
  Field<Node, PointStresses<Dim>> multiplier_before_;
  double penalty_before_ = 0;
  int parts_done_ = 0;  ///< of the step in progress, see StepInProgress
  PhaseWatcher<Dim> watcher_;
  bool attempt_failed_ = false;
};

extern template class Flow<2>;
extern template class Flow<3>;

}  // namespace quicksand
