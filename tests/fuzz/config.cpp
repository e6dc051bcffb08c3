// Whatever text a case file holds, it is refused with a message, or reported and shown so that it reads back.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <vector>

#include "app/case_codec.hpp"
#include "app/case_reference.hpp"
#include "app/case_report.hpp"
#include "app/case_warnings.hpp"
#include "core/config_keys.hpp"
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

/// Pieces that mutations put in: keys, words and what users and YAML trip over.
const std::vector<std::string>& pieces() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> words{"0",         "-1",
                                   "1e308",     "-1e308",
                                   "1e-308",    "nan",
                                   ".inf",      "9999999999999999999",
                                   "0x10",      "1_000",
                                   "1,5",       "true",
                                   "no",        "~",
                                   "''",        "\"\"",
                                   "[]",        "{}",
                                   "[[",        "]]",
                                   "{",         "}",
                                   "&a",        "*a",
                                   "<<: *a",    "!!int",
                                   "!x",        "|",
                                   ">",         "---",
                                   "...",       "%YAML 1.2",
                                   "? ",        ": ",
                                   "- ",        "\t",
                                   "\r\n",      "\xef\xbb\xbf",
                                   "\xff",      "1 in",
                                   "1 atm",     "1 Pa s",
                                   "1 kg/m^3",  "2 furlong",
                                   "3 m^9/s^-9"};
    for (const KeyDescription& key : list_keys(case_codec().schema)) {
      words.push_back(key.path.substr(key.path.rfind('.') + 1) + ": ");
      for (const std::string& example : key.examples) words.push_back(example);
      for (const auto& word : key.words) words.push_back(word.first);
    }
    return words;
  }();
  return all;
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char ch : text) {
    if (ch == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += ch;
    }
  }
  return lines;
}

/// A change that a user's editor could make: lines that go, come twice or move, values and keys that are replaced.
std::string mutate(const std::string& text, unsigned seed) {
  const auto random = [&seed](std::size_t n) {
    seed = seed * 1664525U + 1013904223U;
    return (seed >> 8) % n;
  };
  std::vector<std::string> lines = split_lines(text);
  const std::size_t at = random(lines.size());
  std::string& line = lines[at];
  const std::string& piece = pieces()[random(pieces().size())];
  const auto word_end = [](char ch) { return std::strchr(" ,:[]{}", ch) != nullptr; };
  switch (random(6)) {
    case 0: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
    case 1: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(random(lines.size())), std::string(line)); break;
    case 2: std::swap(line, lines[random(lines.size())]); break;
    case 3: line.insert(random(line.size() + 1), piece); break;
    case 4: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), std::string(random(9), ' ') + piece); break;
    default: {
      std::size_t begin = random(line.size() + 1);
      while (begin > 0 && !word_end(line[begin - 1])) --begin;
      std::size_t end = begin;
      while (end < line.size() && !word_end(line[end])) ++end;
      line.replace(begin, end - begin, piece);
    }
  }
  std::string out;
  for (const std::string& part : lines) out += (out.empty() ? "" : "\n") + part;
  return out;
}

}  // namespace

}  // namespace quicksand::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  quicksand::fuzz::read_text({reinterpret_cast<const char*>(data), size});
  return 0;
}

#ifdef QUICKSAND_FUZZ
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  if (seed % 4 == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string text = quicksand::fuzz::mutate({reinterpret_cast<const char*>(data), size}, seed);
  const std::size_t length = std::min(most, text.size());
  std::memcpy(data, text.data(), length);
  return length;
}
#endif
