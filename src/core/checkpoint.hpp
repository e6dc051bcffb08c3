#pragma once
/// \file
/// Checkpoint files: all that a run needs to go on to the same bits. HDF5 behind a seal.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/archive.hpp"
#include "core/hdf5_file.hpp"
#include "core/seal.hpp"

namespace quicksand {

/// The version grows when the names or meanings of what is stored change.
inline const SealedFormat checkpoint_format{"quicksand checkpoint", 2};

/// Writes a checkpoint, which appears under its name with commit(). All functions throw FileError.
class CheckpointWriter final : public Archive {
 public:
  explicit CheckpointWriter(const std::filesystem::path& path);

  bool loading() const override { return false; }
  void exchange(const std::string& name, std::vector<double>& values) override;
  void exchange(const std::string& name, std::vector<std::int64_t>& values) override;
  void exchange(const std::string& name, std::string& text) override;
  [[noreturn]] void refuse(const std::string& name, const std::string& why) const override;

  void commit();

 private:
  std::filesystem::path path_;
  Hdf5Writer file_;
};

/// Reads a checkpoint. All functions throw FileError.
class CheckpointReader final : public Archive {
 public:
  /// \throws FileError where the file is no checkpoint, of another version of the format, cut short or damaged
  explicit CheckpointReader(const std::filesystem::path& path);

  bool loading() const override { return true; }
  void exchange(const std::string& name, std::vector<double>& values) override;
  void exchange(const std::string& name, std::vector<std::int64_t>& values) override;
  void exchange(const std::string& name, std::string& text) override;
  [[noreturn]] void refuse(const std::string& name, const std::string& why) const override;

  const std::filesystem::path& path() const { return file_.path(); }

 private:
  Hdf5Reader file_;
};

}  // namespace quicksand
