#include "core/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "core/errors.hpp"

namespace quicksand {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error) {
  throw FileError(path.string() + ": " + what + ": " + std::strerror(error));
}

/// File descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : fd_(::open(path.c_str(), flags, 0666)) {
    if (fd_ < 0) fail(path, "cannot open", errno);
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  /// Closes now; some file systems report a failed write only here.
  int close() { return ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

}  // namespace

void flush_to_disk(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDONLY);
  // Some file systems know no fsync for folders and say EINVAL; there is nothing more to do on those.
  if (::fsync(file.get()) != 0 && errno != EINVAL) fail(path, "cannot flush to disk", errno);
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder_of(path_), ignored)) {
    throw FileError(path_.string() + ": folder " + folder_of(path_).string() + " does not exist");
  }
  // The process number keeps two runs apart that write to the same folder by mistake.
  temporary_ = folder_of(path_) / ("." + path_.filename().string() + "." + std::to_string(::getpid()) + ".part");
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  flush_to_disk(temporary_);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "cannot rename the finished file", errno);
  committed_ = true;
  flush_to_disk(folder_of(path_));
}

void write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts) {
  AtomicFile file(path);
  Descriptor out(file.temporary(), O_WRONLY | O_CREAT | O_TRUNC);
  for (std::string_view part : parts) {
    while (!part.empty()) {
      const ssize_t written = ::write(out.get(), part.data(), part.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path, "cannot write", errno);
      part.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  if (out.close() != 0) fail(path, "cannot write", errno);
  file.commit();
}

void write_text_file(const std::filesystem::path& path, std::string_view text) { write_file(path, {text}); }

}  // namespace quicksand
