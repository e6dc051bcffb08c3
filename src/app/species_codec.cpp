#include <charconv>

#include "app/case_codec.hpp"
#include "core/config_schema.hpp"
#include "core/config_variant.hpp"

namespace quicksand {

namespace {

namespace dim = dimension;

/// Pa s^n as a number, or as text with any unit of pressure and the word s^n: the unit depends on the index.
Codec<double> consistency_codec() {
  const auto pressure = quantity(dim::pressure, not_negative);
  Codec<double> codec = pressure;
  codec.schema.find(schema_value)->text = "number in Pa s^n, or a pressure followed by s^n";
  codec.read = [pressure](Reading& reading, const ConfigNode& node, double& out) {
    constexpr std::string_view power = " s^n";
    ConfigNode stress = node;
    double number = 0;
    const bool plain = std::from_chars(node.text.data(), node.text.data() + node.text.size(), number).ptr ==
                       node.text.data() + node.text.size();
    if (node.kind == ConfigNode::Kind::scalar && !plain) {
      if (!node.text.ends_with(power)) {
        reading.problem(node, "must be a number (in Pa s^n), or a pressure followed by s^n, such as 12 Pa s^n");
        return;
      }
      stress.text.resize(stress.text.size() - power.size());
    }
    pressure.read(reading, stress, out);
  };
  return codec;
}

Codec<Law> law_codec() {
  const auto viscosity = quantity(dim::viscosity, not_negative);
  const auto yield_stress = quantity(dim::pressure, not_negative);
  const auto regularization = quantity(dim::time, not_negative);
  return tagged<Law>(
      "law",
      {
          alternative<Law, Inviscid>("inviscid", {}, "no stress but the pressure"),
          alternative<Law, Newtonian>("newtonian",
                                      {required("viscosity", &Newtonian::viscosity, viscosity,
                                                {"dynamic viscosity", "water 1e-3 Pa s, oil 0.1, honey 10", {"1e-3"}})},
                                      "stress proportional to the strain rate"),
          alternative<Law, Bingham>(
              "bingham",
              {required("viscosity", &Bingham::viscosity, viscosity,
                        {"viscosity above the yield stress", "mud 0.1 to 10 Pa s; 0 is allowed", {"2 Pa s"}}),
               required("yield_stress", &Bingham::yield_stress, yield_stress,
                        {"stress below which it is rigid", "mud 10 to 500 Pa, wet sand 1 to 60 kPa", {"100 Pa"}})},
              "Bingham's law: rigid below the yield stress"),
          alternative<Law, Papanastasiou>(
              "papanastasiou",
              {
                  required("viscosity", &Papanastasiou::viscosity, viscosity,
                           {"viscosity above the yield stress", "mud 0.1 to 10 Pa s; 0 is allowed", {"2 Pa s"}}),
                  required("yield_stress", &Papanastasiou::yield_stress, yield_stress,
                           {"stress below which there is hardly any flow",
                            "mud 10 to 500 Pa, wet sand 1 to 60 kPa",
                            {"100 Pa"}}),
                  required("regularization", &Papanastasiou::regularization, regularization,
                           {"exponent of the regularization, a time; larger is closer to Bingham's law",
                            "50 to 1000 times the time of free fall; up to its inverse rates of strain count as rigid",
                            {"50 s"}}),
              },
              "Bingham's law made smooth by an exponential"),
          alternative<Law, HerschelBulkley>(
              "herschel_bulkley",
              {
                  required(
                      "consistency", &HerschelBulkley::consistency, consistency_codec(),
                      {"stress beyond the yield stress at unit strain rate, in Pa s^n", "mud 1 to 100", {"12 Pa s^n"}}),
                  required("index", &HerschelBulkley::index, quantity(dim::none, positive),
                           {"exponent of the strain rate: below 1 shear thins, above it thickens",
                            "mud 0.3 to 0.8",
                            {"0.5"}}),
                  required("yield_stress", &HerschelBulkley::yield_stress, yield_stress,
                           {"stress below which there is hardly any flow",
                            "mud 10 to 500 Pa, wet sand 1 to 60 kPa",
                            {"100 Pa"}}),
                  required("regularization", &HerschelBulkley::regularization, regularization,
                           {"exponent of the regularization, a time; not 0 where index is below 1",
                            "50 to 1000 times the time of free fall",
                            {"50 s"}}),
              },
              "a power of the strain rate beyond a yield stress, made smooth by an exponential"),
          alternative<Law, Casson>(
              "casson",
              {
                  required("viscosity", &Casson::viscosity, viscosity,
                           {"viscosity at large strain rates", "blood 4e-3 Pa s, chocolate 2", {"2 Pa s"}}),
                  required("yield_stress", &Casson::yield_stress, yield_stress,
                           {"stress below which there is hardly any flow",
                            "mud 10 to 500 Pa, wet sand 1 to 60 kPa",
                            {"100 Pa"}}),
                  required("regularization", &Casson::regularization, regularization,
                           {"exponent of the regularization, a time; larger is closer to Casson's law",
                            "50 to 1000 times the time of free fall",
                            {"50 s"}}),
              },
              "roots of yield stress and viscous stress add up to that of the stress, made smooth by an exponential"),
      });
}

}  // namespace

Codec<Species> species_codec() {
  const auto exponent = quantity(dim::none, not_negative);
  const auto concentration = object<Concentration>({
      defaulted("viscosity_exponent", &Concentration::viscosity_exponent, exponent,
                {"growth of the viscosity with the species' share of the mixture, kappa of (43b); 0 is linear",
                 "0, or 2 to 5 for sand in water"}),
      defaulted("yield_exponent", &Concentration::yield_exponent, exponent,
                {"growth of the yield stress with the species' share of the mixture, kappa of (43b); 0 is linear",
                 "0, or 2 to 5 for sand in water"}),
  });
  return object<Species>({
      required("name", &Species::name, identifier(),
               {"name of the species in this file and in the results", "", {"mud"}}),
      required("density", &Species::density, quantity(dim::density, positive),
               {"mass per volume of the pure species",
                "water 1000 kg/m^3, mud 1200 to 1600, sand with water 2000",
                {"1500"}}),
      required("rheology", &Species::law, law_codec(), "constitutive law and its parameters"),
      defaulted("concentration", &Species::concentration, concentration, "how the law depends on the concentration"),
  });
}

}  // namespace quicksand
