#pragma once
/// \file
/// Files that appear under their final name only when complete.
#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace quicksand {

/// A file under construction: written under a temporary name in the same folder, renamed by commit().
///
/// An object that dies without commit() removes the temporary file and leaves a file of that name as it was.
class AtomicFile {
 public:
  /// \throws FileError if the folder does not exist
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& path() const { return path_; }            ///< the final name
  const std::filesystem::path& temporary() const { return temporary_; }  ///< where to write until commit()

  /// Brings the closed temporary file safely to the disk and gives it its final name, replacing what was there.
  /// \throws FileError with path and reason
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// Brings what was written to a file, or the names in a folder, safely to the disk. \throws FileError
void flush_to_disk(const std::filesystem::path& path);

/// Writes a file from its parts, one after the other, complete or not at all.
/// \throws FileError with path and reason
void write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts);

/// The same for a text.
void write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace quicksand
