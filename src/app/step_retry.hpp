#pragma once
/// \file
/// Steps that fail are tried again with half the time step.
#include <functional>
#include <string>

#include "core/errors.hpp"
#include "core/text_output.hpp"
#include "physics/flow.hpp"

namespace quicksand {

/// How far the time step may be halved.
struct RetryLimits {
  int halvings = 0;
  double least_step = 0;
};

/// Advances by at most dt: a step that fails is tried again, from where it started, with half of it.
/// \param say  is told of every failure that is followed by another try
/// \throws NumericalError of the last try when all fail
template <int Dim>
StepReport advance_with_retries(Flow<Dim>& flow, double dt, const RetryLimits& limits,
                                const std::function<void(const std::string&)>& say) {
  for (int halvings = 0;; ++halvings) {
    try {
      return flow.advance(dt);
    } catch (const NumericalError& error) {
      if (halvings == limits.halvings) {
        throw NumericalError(std::string(error.what()) + ", with dt " + number_text(dt) + " after " +
                             std::to_string(halvings) + " halvings");
      }
      dt /= 2;
      if (dt < limits.least_step) {
        throw NumericalError(std::string(error.what()) + "; half the step, " + number_text(dt) +
                             ", is below the least that is tried, " + number_text(limits.least_step));
      }
      say("step " + std::to_string(flow.state().step + 1) + ": " + error.what() + "; trying again with dt " +
          number_text(dt));
    }
  }
}

}  // namespace quicksand
