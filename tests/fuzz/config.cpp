// Whatever text a case file holds, it is refused with a message, or reported and shown so that it reads back.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <vector>

#include "app/case_reference.hpp"
#include "app/case_report.hpp"
#include "app/case_warnings.hpp"
#include "core/errors.hpp"
#include "fuzz/fuzz.hpp"

namespace quicksand::fuzz {

namespace {

/// Larger grids only take longer.
constexpr long most_axis_cells = 200;
constexpr double most_cells = 1000;

/// Whether a text asks for more cells than is worth the time, by the digits that follow the key.
bool is_long(const std::string& text) {
  const std::string key = "cells";
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    const std::size_t begin = text.find_first_of("0123456789\n", at);
    const std::size_t end = text.find_first_not_of("0123456789", begin);
    if (begin != std::string::npos && std::min(end, text.size()) - begin > 3) return true;
  }
  return false;
}

bool is_small(const CaseConfig& config) {
  std::vector<GridConfig> grids{config.grid};
  for (const StageConfig& stage : config.stages) grids.push_back(grid_of(config, stage));
  return !config.regrid && std::all_of(grids.begin(), grids.end(), [](const GridConfig& grid) {
    const std::vector<long> cells = axis_cells(grid);
    return count_cells(grid) <= most_cells && *std::max_element(cells.begin(), cells.end()) <= most_axis_cells;
  });
}

void require(bool holds, const char* what) {
  if (holds) return;
  std::cerr << what << std::endl;
  std::abort();
}

void read_text(const std::string& text) {
  try {
    if (is_long(text)) return;
    const CaseConfig config = parse_case(text, "case.yaml");
    const std::string shown = to_yaml(config);
    require(to_yaml(parse_case(shown, "shown")) == shown, "the case that is shown reads back to another one");
    require(to_yaml(parse_case(explained_case(config), "explained")) == shown,
            "the case that is explained reads back to another one");
    if (!is_small(config)) return;
#ifdef QUICKSAND_FUZZ
    // Grids are built for one in eight: that takes longest.
    if (std::hash<std::string>{}(text) % 8 != 0) return;
#endif
    case_report(config);
    case_warnings(config);
  } catch (const InputError& error) {
    require(std::strlen(error.what()) > 0, "no message");
  }
}

}  // namespace

}  // namespace quicksand::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  quicksand::fuzz::read_text({reinterpret_cast<const char*>(data), size});
  return 0;
}
