#include <limits>

#include "app/case_codec.hpp"

namespace quicksand {

namespace {

namespace dim = dimension;
constexpr Range above_one{1, std::numeric_limits<double>::infinity(), true};

}  // namespace

Codec<InitialBubble> bubble_codec() {
  return object<InitialBubble>({
      required("center", &InitialBubble::center, vector_of(dim::length),
               {"middle; on the axis in axisymmetric cases", "", {"[0, -1 m]"}}),
      required("radius", &InitialBubble::radius, quantity(dim::length, positive),
               {"radius; a disc in planar cases, else a ball", "at least four cells, better eight", {"0.1 m"}}),
      required("pressure", &InitialBubble::pressure, quantity(dim::pressure, positive),
               {"pressure at the start; P V^gamma is constant from there on",
                "that of the liquid around it, or more",
                {"2 atm"}}),
      required("adiabatic_exponent", &InitialBubble::adiabatic_exponent, quantity(dim::none, above_one),
               {"gamma of P V^gamma = constant", "1.4 for air, 1.25 to 1.3 for gas of explosions", {"1.4"}}),
  });
}

Codec<InitialCharge> charge_codec() {
  return object<InitialCharge>({
      required("center", &InitialCharge::center, vector_of(dim::length),
               {"middle; on the axis in axisymmetric cases", "", {"[0, -1 m]"}}),
      required("mass", &InitialCharge::mass, quantity(dim::mass, positive),
               {"mass of the whole charge, wherever planes of symmetry cut it", "", {"0.203 g"}}),
      required("radius_constant", &InitialCharge::radius_constant, quantity(dim::none, positive),
               {"J of the largest radius, in ft (ftH2O/lb)^(1/3), a plain number",
                "13.55 for TNT, 11 for the report's detonators",
                {"13.55"}}),
      required("minimum_radius_constant", &InitialCharge::minimum_radius_constant, quantity(dim::none, positive),
               {"q of the first radius, in ft/lb^(1/3), a plain number",
                "0.268 for TNT, 0.272 for the report's detonators",
                {"0.268"}}),
      required("adiabatic_exponent", &InitialCharge::adiabatic_exponent, quantity(dim::none, above_one),
               {"gamma of the explosion's gas", "1.25 for TNT, 1.3 for the report's detonators", {"1.25"}}),
      maybe("thickness", &InitialCharge::thickness, quantity(dim::length, positive),
            {"planar cases only, and required there: extent across the plane, over which the mass is spread",
             "",
             {"2 in"}}),
  });
}

Codec<TrappedGas> trapped_gas_codec() {
  return object<TrappedGas>({
      defaulted("adiabatic", &TrappedGas::adiabatic, flag(),
                {"whether ambient gas that liquid encloses becomes a bubble; else it keeps the ambient pressure",
                 "true where a cavity may close"}),
      defaulted("adiabatic_exponent", &TrappedGas::exponent, quantity(dim::none, above_one),
                {"gamma of ambient gas", "1.4, air"}),
  });
}

}  // namespace quicksand
