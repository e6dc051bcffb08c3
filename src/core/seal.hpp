#pragma once
/// \file
/// Seals: a few lines of text in front of a file that tell its format and version, and length and checksum of the rest.
/// By them a file that was cut short, damaged or made by another program is known before anything in it is read.
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace quicksand {

/// Bytes at the beginning of a file that its seal takes.
inline constexpr std::size_t seal_size = 512;

/// What a seal says of its file.
struct SealedFormat {
  std::string name;
  int version = 0;
};

/// The seal, seal_size bytes, of a file that goes on with `content`.
std::string make_seal(const SealedFormat& format, std::string_view content);

/// Makes sure that a file is of a format and as it was when it was sealed.
/// \throws FileError that says what is wrong: another format or version, cut short, damaged
void check_seal(const std::filesystem::path& file, const SealedFormat& format);

}  // namespace quicksand
