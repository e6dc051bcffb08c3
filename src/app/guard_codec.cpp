#include "app/case_codec.hpp"

namespace quicksand {

Codec<GuardSettings> guard_codec() {
  // Less is round-off.
  const auto part = quantity(dimension::none, {1e-13, 1, false});
  return object<GuardSettings>({
      defaulted("halvings", &GuardSettings::halvings, whole_number(0, 50),
                {"how often a step that fails is tried again with half the time step",
                 "the default; 0 ends the run at the first failure"}),
      defaulted("volume_error", &GuardSettings::volume_error, part,
                {"largest change of a species' volume in a step, as a part of all liquid",
                 "the default; shipped cases stay below 1e-14"}),
      defaulted("energy_rise", &GuardSettings::energy_rise, part,
                {"largest rise of kinetic energy in redistribution and projection, as a part of the largest energy so "
                 "far; at least solver.tolerance",
                 "the default; shipped cases stay below 1e-15"}),
  });
}

}  // namespace quicksand
