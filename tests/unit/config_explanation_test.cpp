// Schema, reader, explanations and reference speak of the same keys.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>

#include "app/case_codec.hpp"
#include "app/case_reference.hpp"
#include "app/case_warnings.hpp"
#include "config_test_case.hpp"
#include "core/config_keys.hpp"

namespace quicksand {
namespace {

std::vector<KeyDescription> all_keys() { return list_keys(case_codec().schema); }

TEST(ConfigExplanation, EveryKeySaysWhatItIsAndWhatItTakes) {
  const std::vector<KeyDescription> keys = all_keys();
  EXPECT_GT(keys.size(), 100u);
  for (const KeyDescription& key : keys) {
    SCOPED_TRACE(key.path + " " + key.of);
    EXPECT_GE(key.meaning.size(), 3u);
    EXPECT_FALSE(key.value.empty());
    EXPECT_FALSE(key.required && !key.standard.empty());
    for (const auto& [word, meaning] : key.words) EXPECT_FALSE(meaning.empty()) << word;
  }
}

/// Every kind of mapping of a case, with an unknown key `zzz` in it, and the path of the mapping.
struct Intruder {
  std::string path;
  std::string of;
  std::string setting;
};

/// The keys that the reader says it allows.
std::set<std::string> keys_of_reader(const std::string& error) {
  const std::string mark = "allowed keys are ";
  const std::size_t begin = error.find(mark);
  if (begin == std::string::npos) return {};
  std::istringstream list(error.substr(begin + mark.size(), error.find('\n', begin) - begin - mark.size()));
  std::set<std::string> keys;
  for (std::string key; std::getline(list >> std::ws, key, ',');) keys.insert(key);
  return keys;
}

void expect_same_keys(const Intruder& m) {
  SCOPED_TRACE(m.setting);
  std::set<std::string> described;
  for (const KeyDescription& key : all_keys()) {
    const std::size_t dot = key.path.rfind('.');
    const std::string parent = dot == std::string::npos ? "" : key.path.substr(0, dot);
    const bool is_tag = !key.words.empty();
    if (parent == m.path && (key.of == m.of || is_tag)) described.insert(key.path.substr(dot + 1));
  }
  const std::string error = error_of(valid_case, {m.setting});
  EXPECT_EQ(keys_of_reader(error), described) << error;
}

const Intruder intruders[] = {
    {"", "", "zzz=1"},
    {"grid", "", "grid.zzz=1"},
    {"grid.x", "", "grid.x.zzz=1"},
    {"boundaries", "", "boundaries.zzz=1"},
    {"boundaries.x_min.inflow", "", "boundaries.x_min={inflow: {velocity: [0, 1], zzz: 1}}"},
    {"species", "", "species.0.zzz=1"},
    {"species.concentration", "", "species.0.concentration={zzz: 1}"},
    {"species.rheology", "newtonian", "species.0.rheology={law: newtonian, viscosity: 1, zzz: 1}"},
    {"species.rheology", "bingham", "species.0.rheology={law: bingham, zzz: 1}"},
    {"species.rheology", "papanastasiou", "species.0.rheology={law: papanastasiou, zzz: 1}"},
    {"species.rheology", "herschel_bulkley", "species.0.rheology={law: herschel_bulkley, zzz: 1}"},
    {"species.rheology", "casson", "species.0.rheology={law: casson, zzz: 1}"},
    {"initial", "", "initial.0.zzz=1"},
    {"initial.shape", "", "initial.0.shape={zzz: 1}"},
    {"initial.shape.box", "", "initial.0.shape={box: {zzz: 1}}"},
    {"initial.shape.layer", "", "initial.0.shape={layer: {zzz: 1}}"},
    {"initial.shape.cylinder", "", "initial.0.shape={cylinder: {zzz: 1}}"},
    {"initial.shape.sphere", "", "initial.0.shape={sphere: {zzz: 1}}"},
    {"initial.shape.half_space", "", "initial.0.shape={half_space: {zzz: 1}}"},
    {"initial.shape.polygon", "", "initial.0.shape={polygon: {zzz: 1}}"},
    {"initial.shape.wave", "", "initial.0.shape={wave: {zzz: 1}}"},
    {"bubbles", "", "bubbles=[{zzz: 1}]"},
    {"charges", "", "charges=[{zzz: 1}]"},
    {"trapped_gas", "", "trapped_gas={zzz: 1}"},
    {"time", "", "time.zzz=1"},
    {"stages", "", "stages=[{zzz: 1}]"},
    {"stages.grid", "", "stages=[{until: 1, grid: {zzz: 1}}]"},
    {"regrid", "", "regrid={zzz: 1}"},
    {"solver", "", "solver={zzz: 1}"},
    {"guard", "", "guard={zzz: 1}"},
    {"output", "", "output.zzz=1"},
    {"output.fields", "", "output.fields.zzz=1"},
    {"output.checkpoint", "", "output.checkpoint={zzz: 1}"},
    {"output.crater", "", "output.crater={zzz: 1}"},
};
TEST(ConfigExplanation, TheReaderHasTheKeysOfTheSchema) {
  for (const Intruder& intruder : intruders) expect_same_keys(intruder);
}

TEST(ConfigExplanation, AllMappingsAreAmongTheIntruders) {
  std::set<std::string> tested;
  for (const Intruder& m : intruders) tested.insert(m.path);
  tested.insert("boundaries.x_min");  // which is a word, or a mapping of several forms
  for (const KeyDescription& key : all_keys()) {
    const std::size_t dot = key.path.rfind('.');
    const std::string parent = dot == std::string::npos ? "" : key.path.substr(0, dot);
    EXPECT_TRUE(tested.count(parent)) << key.path;
  }
}

TEST(ConfigExplanation, ExamplesAreRead) {
  // Examples are put in place of a value; whatever else they break, they are not refused themselves.
  const std::string si = with("units: none\n", "");
  for (const KeyDescription& key : all_keys()) {
    if (key.path.find("charges") == 0 || key.path.find("boundaries") == 0) continue;
    for (const std::string& example : key.examples) {
      std::string setting;
      std::string name = key.path.substr(key.path.rfind('.') + 1);
      if (key.path.starts_with("initial.shape.")) {
        const std::string shape = key.path.substr(14, key.path.rfind('.') - 14);
        setting = "initial.0.shape={" + shape + ": {" + name + ": " + example + "}}";
      } else if (!key.of.empty()) {
        setting = "species.0.rheology={law: " + key.of + ", " + name + ": " + example + "}";
      } else if (key.path.starts_with("species.") || key.path.starts_with("initial.")) {
        setting = key.path.substr(0, 7) + ".0." + key.path.substr(8) + "=" + example;
      } else if (key.path.starts_with("bubbles.") || key.path.starts_with("stages.")) {
        setting = key.path.substr(0, key.path.find('.')) + "=[{" + name + ": " + example + "}]";
      } else {
        setting = key.path + "=" + example;
      }
      for (const std::string refusal : {"must be a", "must be text", "must be greater", "must be at", "not valid"}) {
        const std::string error = error_of(si, {setting});
        EXPECT_EQ(error.find(name + ": " + refusal), std::string::npos) << setting << "\n" << error;
      }
    }
  }
}

TEST(ConfigExplanation, ExplainedCasesReadBackToTheSame) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(QUICKSAND_SOURCE_DIR "/configs")) {
    if (entry.path().extension() != ".yaml") continue;
    SCOPED_TRACE(entry.path().string());
    const CaseConfig config = read_case(entry.path().string());
    EXPECT_EQ(to_yaml(parse_case(explained_case(config), "explained")), to_yaml(config));
  }
}

TEST(ConfigExplanation, TheTemplateRunsAndNamesEveryKey) {
  const std::string text = case_template();
  const CaseConfig config = parse_case(text, "template");
  EXPECT_TRUE(case_warnings(config).empty());
  for (const KeyDescription& key : all_keys()) {
    EXPECT_NE(text.find(key.path.substr(key.path.rfind('.') + 1) + ":"), std::string::npos) << key.path;
  }
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

TEST(ConfigExplanation, KeysAreFoundByPathNumberAndEnd) {
  EXPECT_EQ(explain_key("time.cfl"), explain_key("cfl"));
  EXPECT_EQ(explain_key("species[0].density"), explain_key("species.density"));
  EXPECT_EQ(explain_key("species.0.density"), explain_key("species.density"));
  EXPECT_NE(explain_key("boundaries.z_max.open").find("pressure outside"), std::string::npos)
      << "keys of sides are described once";
  EXPECT_NE(explain_key("viscosity").find("(casson)"), std::string::npos) << "all that have the name";
  EXPECT_NE(explain_key("grid").find("\n    dimension: "), std::string::npos);
  try {
    explain_key("solver.tolerence");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "'solver.tolerence' is no key of a case; did you mean 'solver.tolerance'?");
  }
}

TEST(ConfigExplanation, TheReferenceHasARowPerKey) {
  const std::string page = case_reference();
  for (const KeyDescription& key : all_keys()) {
    const std::size_t dot = key.path.find('.');
    const std::string row =
        dot == std::string::npos ? "## `" + key.path + "`" : "\n| `" + key.path.substr(dot + 1) + "`";
    EXPECT_NE(page.find(row), std::string::npos) << key.path;
  }
}

}  // namespace
}  // namespace quicksand
