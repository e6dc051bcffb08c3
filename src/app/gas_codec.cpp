#include <limits>

#include "app/case_codec.hpp"

namespace quicksand {

namespace {

namespace dim = dimension;
constexpr Range above_one{1, std::numeric_limits<double>::infinity(), true};

}  // namespace

Codec<InitialBubble> bubble_codec() {
  return object<InitialBubble>({
      required("center", &InitialBubble::center, vector_of(dim::length), "middle"),
      required("radius", &InitialBubble::radius, quantity(dim::length, positive), "radius"),
      required("pressure", &InitialBubble::pressure, quantity(dim::pressure, positive), "pressure at the start"),
      required("adiabatic_exponent", &InitialBubble::adiabatic_exponent, quantity(dim::none, above_one),
               "gamma of P V^gamma = constant"),
  });
}

Codec<InitialCharge> charge_codec() {
  return object<InitialCharge>({
      required("center", &InitialCharge::center, vector_of(dim::length), "middle"),
      required("mass", &InitialCharge::mass, quantity(dim::mass, positive), "mass of the whole charge"),
      required("radius_constant", &InitialCharge::radius_constant, quantity(dim::none, positive),
               "J of the largest radius, in ft (ftH2O/lb)^(1/3)"),
      required("minimum_radius_constant", &InitialCharge::minimum_radius_constant, quantity(dim::none, positive),
               "q of the first radius, in ft/lb^(1/3)"),
      required("adiabatic_exponent", &InitialCharge::adiabatic_exponent, quantity(dim::none, above_one),
               "gamma of the explosion's gas"),
      maybe("thickness", &InitialCharge::thickness, quantity(dim::length, positive),
            "planar cases only, and required there: extent across the plane, over which the mass is spread"),
  });
}

Codec<TrappedGas> trapped_gas_codec() {
  return object<TrappedGas>({
      defaulted("adiabatic", &TrappedGas::adiabatic, flag(),
                "whether ambient gas that liquid encloses becomes a bubble; else it keeps the ambient pressure"),
      defaulted("adiabatic_exponent", &TrappedGas::exponent, quantity(dim::none, above_one), "gamma of ambient gas"),
  });
}

}  // namespace quicksand
