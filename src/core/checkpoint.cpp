#include "core/checkpoint.hpp"

#include <string_view>

#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Enough to shrink the many zeros of empty cells.
constexpr int compression = 1;

const std::filesystem::path& checked(const std::filesystem::path& path) {
  check_seal(path, checkpoint_format);
  return path;
}

[[noreturn]] void refuse_value(const std::filesystem::path& path, const std::string& name, const std::string& why) {
  throw FileError(path.string() + ": '" + name + "': " + why);
}

}  // namespace

CheckpointWriter::CheckpointWriter(const std::filesystem::path& path)
    : path_(path), file_(path, compression, seal_size) {}

void CheckpointWriter::exchange(const std::string& name, std::vector<double>& values) { file_.write(name, values); }

void CheckpointWriter::exchange(const std::string& name, std::vector<std::int64_t>& values) {
  file_.write(name, values);
}

void CheckpointWriter::exchange(const std::string& name, std::string& text) {
  const std::vector<unsigned char> bytes(text.begin(), text.end());
  file_.write(name, bytes, {bytes.size()});
}

void CheckpointWriter::refuse(const std::string& name, const std::string& why) const { refuse_value(path_, name, why); }

void CheckpointWriter::commit() {
  file_.commit([](std::string_view content) { return make_seal(checkpoint_format, content); });
}

CheckpointReader::CheckpointReader(const std::filesystem::path& path) : file_(checked(path)) {}

void CheckpointReader::exchange(const std::string& name, std::vector<double>& values) { values = file_.doubles(name); }

void CheckpointReader::exchange(const std::string& name, std::vector<std::int64_t>& values) {
  values = file_.integers(name);
}

void CheckpointReader::exchange(const std::string& name, std::string& text) {
  const std::vector<unsigned char> bytes = file_.bytes(name);
  text.assign(bytes.begin(), bytes.end());
}

void CheckpointReader::refuse(const std::string& name, const std::string& why) const {
  refuse_value(path(), name, why);
}

}  // namespace quicksand
