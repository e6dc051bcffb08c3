#include "app/crater_codec.hpp"

#include <string>

namespace quicksand {

Codec<CraterSettings> crater_codec() {
  return object<CraterSettings>({
      required("species", &CraterSettings::species, identifier(), "species that the bed is made of"),
      maybe("level", &CraterSettings::level, quantity(dimension::length),
            "z of the undisturbed bed; absent: the median height of the initial bed"),
      maybe("every", &CraterSettings::every, quantity(dimension::time, positive),
            "interval; absent: whenever fields are written"),
  });
}

void check_crater(const CaseConfig& config, Reading& reading) {
  if (!config.output.crater) return;
  const CraterSettings& crater = *config.output.crater;
  const std::string path = "output.crater";
  if (reading.clean(path + ".species") && reading.clean("species") &&
      species_number(config, crater.species) == config.species.size()) {
    std::vector<std::string> names;
    for (const Species& s : config.species) names.push_back(s.name);
    reading.problem(path + ".species", in_quotes(crater.species) + " is not a species; they are " + join(names) +
                                           suggestion(crater.species, names));
  }
  if (!crater.level || !reading.clean(path + ".level") || !reading.clean("grid")) return;
  const Extent domain = domain_of(config.grid);
  if (*crater.level < domain.low[2] || *crater.level > domain.high[2]) {
    reading.problem(path + ".level", "must lie within the grid, from z = " + shortest(domain.low[2]) + " to " +
                                         shortest(domain.high[2]) + ", not at " + shortest(*crater.level));
  }
}

}  // namespace quicksand
