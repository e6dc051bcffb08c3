#include "core/seal.hpp"

#include <cstdint>
#include <fstream>
#include <sstream>
#include <vector>

#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Length and checksum of what stands behind a seal: FNV-1a, 64 bits, which no change of a single byte leaves as it is.
struct Content {
  std::uint64_t length = 0;
  std::uint64_t checksum = 14695981039346656037U;
  friend bool operator==(const Content&, const Content&) = default;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw FileError(file.string() + ": " + why);
}

void add(Content& content, std::string_view part) {
  for (const char c : part) {
    content.checksum = (content.checksum ^ static_cast<unsigned char>(c)) * 1099511628211U;
  }
  content.length += part.size();
}

/// What stands behind the seal of a file that has been read up to there.
Content measure(std::istream& in, const std::filesystem::path& file) {
  Content content;
  std::vector<char> part(std::size_t{1} << 16);
  while (in) {
    in.read(part.data(), static_cast<std::streamsize>(part.size()));
    add(content, {part.data(), static_cast<std::size_t>(in.gcount())});
  }
  if (in.bad()) refuse(file, "can't be read");
  return content;
}

std::string seal_text(const SealedFormat& format, const Content& content) {
  std::string text = format.name + "\nversion " + std::to_string(format.version) + "\nlength " +
                     std::to_string(content.length) + "\nchecksum " + std::to_string(content.checksum) + "\n";
  text.resize(seal_size, '\0');
  return text;
}

}  // namespace

std::string make_seal(const SealedFormat& format, std::string_view content) {
  Content measured;
  add(measured, content);
  return seal_text(format, measured);
}

void check_seal(const std::filesystem::path& file, const SealedFormat& format) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(file, "can't be opened");
  std::string text(seal_size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  std::istringstream lines(text);
  std::string name;
  std::getline(lines, name);
  if (name != format.name) refuse(file, "is not a " + format.name);
  int version = 0;
  Content sealed;
  std::string word[3];
  lines >> word[0] >> version >> word[1] >> sealed.length >> word[2] >> sealed.checksum;
  if (lines && version != format.version) {
    refuse(file, "has version " + std::to_string(version) + " of the format, this program reads version " +
                     std::to_string(format.version));
  }
  const Content found = measure(stream, file);
  if (lines && found.length < sealed.length) {
    refuse(file, "is cut short: " + std::to_string(found.length) + " bytes of " + std::to_string(sealed.length));
  }
  if (!lines || found != sealed || text != seal_text(format, sealed)) refuse(file, "is damaged: its checksum is wrong");
}

}  // namespace quicksand
