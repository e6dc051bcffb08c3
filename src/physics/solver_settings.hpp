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

}  // namespace quicksand
