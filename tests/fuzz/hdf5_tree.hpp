#pragma once
/// \file
/// What an HDF5 file holds, to be spoiled by a fuzzer and written again. The library makes the files, so that they are
/// sound HDF5 and what is tested is how their content is read, not how the library reads its own format.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/fuzz.hpp"

namespace quicksand::fuzz {

/// Types of values in the files that are written.
enum class ValueType { real, integer, byte, single, text, long_text, compound };
inline constexpr std::size_t value_types = 7;

/// A dataset or an attribute of the root, flat.
struct Item {
  std::string name;
  bool is_attribute = false;
  ValueType type = ValueType::real;
  std::vector<std::size_t> extents;
  std::vector<double> values;  ///< numbers; of texts the bytes
};

/// All datasets and attributes of a file.
std::vector<Item> read_tree(const std::filesystem::path& file);

/// Changes items as the input says: some go, others get other values, types or extents, up to absurd ones.
void spoil(std::vector<Item>& items, Input& input);

/// \param front  bytes that stay free in front
void write_tree(const std::filesystem::path& file, const std::vector<Item>& items, std::size_t front);

}  // namespace quicksand::fuzz
