#include "app/case_config.hpp"

#include <algorithm>
#include <utility>

#include "app/case_codec.hpp"
#include "core/config_reader.hpp"
#include "core/config_schema.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

CaseConfig read_document(ConfigDocument document, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) apply_setting(document, setting);
  Reading reading(std::move(document));
  reading.units = peek_units(reading.root());
  reading.vector_length = peek_dimension(reading.root());
  CaseConfig config;
  case_codec().read(reading, reading.root(), config);
  check_case(config, reading);
  if (!reading.problems().empty()) throw InputError(list_problems(reading.problems()));
  return config;
}

}  // namespace

CaseConfig read_case(const std::string& file, const std::vector<std::string>& settings) {
  return read_document(read_yaml_file(file), settings);
}

CaseConfig parse_case(const std::string& text, const std::string& source, const std::vector<std::string>& settings) {
  return read_document(parse_yaml(text, source), settings);
}

std::size_t species_number(const CaseConfig& config, const std::string& name) {
  const auto found =
      std::find_if(config.species.begin(), config.species.end(), [&](const Species& s) { return s.name == name; });
  return static_cast<std::size_t>(found - config.species.begin());
}

std::string to_yaml(const CaseConfig& config) { return to_yaml(case_codec().write(config)); }

std::string case_schema() {
  ConfigNode schema = make_map();
  schema.add("$schema", make_text("https://json-schema.org/draft/2020-12/schema"));
  schema.add("title", make_text("Quicksand case"));
  const ConfigNode plain = plain_schema(case_codec().schema);
  for (const ConfigNode& entry : plain.children) schema.add(entry.key, entry);
  return to_json(schema).text();
}

}  // namespace quicksand
