// The cases that the documentation shows are read without an error.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "app/case_config.hpp"

namespace quicksand {
namespace {

/// The blocks of YAML of a page.
std::vector<std::string> yaml_blocks(const std::string& page) {
  std::ifstream file(std::string(QUICKSAND_SOURCE_DIR) + "/" + page);
  EXPECT_TRUE(file) << page;
  std::vector<std::string> blocks;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line == "```yaml") {
      inside = true;
      blocks.emplace_back();
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

/// The sections of a case by their keys.
std::map<std::string, std::string> sections(const std::string& text) {
  std::map<std::string, std::string> found;
  std::istringstream lines(text);
  std::string key;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != ' ' && line[0] != '#') key = line.substr(0, line.find(':'));
    found[key] += line + "\n";
  }
  return found;
}

TEST(DocumentedCases, EveryBlockIsACaseWithThoseSectionsOfTheFirst) {
  const std::vector<std::string> blocks = yaml_blocks("docs/cases.md");
  ASSERT_GE(blocks.size(), 15u);
  for (const std::string& block : blocks) {
    std::map<std::string, std::string> parts = sections(blocks.front());
    for (const auto& [key, text] : sections(block)) parts[key] = text;
    std::string text;
    for (const auto& [key, part] : parts) text += part;
    EXPECT_NO_THROW(parse_case(text, "docs/cases.md")) << text;
  }
}

TEST(DocumentedCases, TheCaseOfTheReadmeIsRead) {
  const std::vector<std::string> blocks = yaml_blocks("README.md");
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_NO_THROW(parse_case(blocks.front(), "README.md"));
}

}  // namespace
}  // namespace quicksand
