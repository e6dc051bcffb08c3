#include "app/crater_codec.hpp"

#include <algorithm>
#include <string>

namespace quicksand {

Codec<CraterSettings> crater_codec() {
  return object<CraterSettings>({
      required("species", &CraterSettings::species, one_or_list_of(identifier()),
               {"species that the bed is made of, or a list of them", "", {"sand"}}),
      maybe("level", &CraterSettings::level, quantity(dimension::length),
            {"z of the undisturbed bed; absent: the median height of the initial bed", "absent", {"-3 in"}}),
      maybe("every", &CraterSettings::every, quantity(dimension::time, positive),
            {"interval; absent: whenever fields are written", "absent, or less for histories", {"1 ms"}}),
  });
}

void check_crater(const CaseConfig& config, Reading& reading) {
  if (!config.output.crater) return;
  const CraterSettings& crater = *config.output.crater;
  const std::string path = "output.crater";
  std::vector<std::string> names;
  for (const Species& s : config.species) names.push_back(s.name);
  const std::string species = path + ".species";
  const bool list = reading.nearest(species).kind == ConfigNode::Kind::list;
  for (std::size_t i = 0; i < crater.species.size() && reading.clean("species"); ++i) {
    const std::string& name = crater.species[i];
    const std::string place = list ? child_path(species, i) : species;
    if (!reading.clean(place)) continue;
    if (species_number(config, name) == names.size()) {
      reading.problem(place, in_quotes(name) + " is not a species; they are " + join(names) + suggestion(name, names));
    } else if (std::find(crater.species.begin(), crater.species.begin() + static_cast<std::ptrdiff_t>(i), name) !=
               crater.species.begin() + static_cast<std::ptrdiff_t>(i)) {
      reading.problem(place, in_quotes(name) + " is in the list already");
    }
  }
  if (!crater.level || !reading.clean(path + ".level") || !reading.clean("grid")) return;
  const Extent domain = domain_of(config.grid);
  if (*crater.level < domain.low[2] || *crater.level > domain.high[2]) {
    reading.problem(path + ".level", "must lie within the grid, from z = " + shortest(domain.low[2]) + " to " +
                                         shortest(domain.high[2]) + ", not at " + shortest(*crater.level));
  }
}

}  // namespace quicksand
