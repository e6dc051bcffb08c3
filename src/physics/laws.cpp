#include "physics/laws.hpp"

namespace quicksand {

namespace {

struct ToRheology {
  Rheology operator()(const Inviscid&) const { return {}; }
  Rheology operator()(const Newtonian& law) const { return {.viscosity = law.viscosity}; }
  Rheology operator()(const Papanastasiou& law) const {
    return {.viscosity = law.viscosity, .yield_stress = law.yield_stress, .regularization = law.regularization};
  }
};

}  // namespace

Rheology rheology(const Law& law) { return std::visit(ToRheology{}, law); }

}  // namespace quicksand
