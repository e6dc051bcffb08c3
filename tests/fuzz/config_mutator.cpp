// Changes of case files that a user could make, besides those of single bytes.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "app/case_codec.hpp"
#include "core/config_keys.hpp"
#include "fuzz/fuzz.hpp"

namespace quicksand::fuzz {

namespace {

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

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  if (seed % 4 == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string text = quicksand::fuzz::mutate({reinterpret_cast<const char*>(data), size}, seed);
  const std::size_t length = std::min(most, text.size());
  std::memcpy(data, text.data(), length);
  return length;
}
