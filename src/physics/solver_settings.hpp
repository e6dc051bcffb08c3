#pragma once
/// \file
/// Settings of the numerical method that a user may change.

namespace quicksand {

/// Iteration for the nonlinear viscous step (48)-(49). Rigid yield stresses (35) are added by the method of multipliers
/// around the first three; `dual` is an accelerated gradient method for their stresses.
enum class ViscousIteration { newton, anderson, picard, dual };

/// Thresholds, tolerances and limits of the solves of one time step.
struct SolverSettings {
  double liquid_threshold = 0.5;    ///< eps: cells with sum of fractions >= 1 - eps are liquid
  double tolerance = 1e-9;          ///< relative residual of the linear solves
  int max_iterations = 500;         ///< of a linear solve
  double viscous_tolerance = 1e-4;  ///< relative change or residual at which the viscous iteration stops
  ViscousIteration viscous_iteration = ViscousIteration::newton;
  int viscous_max_iterations = 100;
};

/// When a step counts as failed although all its solves converged, and how often a failed one is tried again.
struct GuardSettings {
  int halvings = 8;            ///< of the time step
  double volume_error = 1e-9;  ///< change of a species' volume in a step, relative to that of all
  double energy_rise = 1e-6;   ///< of kinetic energy in redistribution or projection, see StepReport::energy_scale
};

}  // namespace quicksand
