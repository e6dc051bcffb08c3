#pragma once
/// \file
/// Writing and reading HDF5 files. The only part of the code that knows the HDF5 library.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quicksand {

/// Version of the HDF5 library in use, such as "1.10.8".
std::string hdf5_version();

/// Extents of a dataset, slowest axis first; empty for a single value.
using Extents = std::vector<std::size_t>;

/// Number of values of a dataset.
std::size_t count(const Extents& extents);

/// New HDF5 file that appears under its name with commit() and not before. It is put together in memory: when a disk
/// is full the library neither tells of all that it failed to write nor can it close the file.
///
/// Names are paths inside the file ("fields/pressure"); groups on the way are made as needed. All functions throw
/// FileError with the file, the object and the reason.
class Hdf5Writer {
 public:
  /// \param compression  0 (none) ... 9 (smallest): deflate level of the datasets that follow, after shuffling the
  /// bytes
  /// \param front  bytes kept free in front of what HDF5 writes: 0, or 512 times a power of two
  explicit Hdf5Writer(const std::filesystem::path& path, int compression = 0, std::size_t front = 0);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Writes a dataset, C order. \pre values.size() == count(extents)
  void write(const std::string& name, std::span<const double> values, const Extents& extents);
  void write(const std::string& name, std::span<const std::int64_t> values, const Extents& extents);
  void write(const std::string& name, std::span<const unsigned char> values, const Extents& extents);
  /// One-dimensional datasets.
  void write(const std::string& name, const std::vector<double>& values) { write(name, values, {values.size()}); }
  void write(const std::string& name, const std::vector<std::int64_t>& values) { write(name, values, {values.size()}); }

  /// Attributes of the file's root, or of the group or dataset `object` that exists already.
  void attribute(const std::string& name, double value, const std::string& object = "/");
  void attribute(const std::string& name, std::int64_t value, const std::string& object = "/");
  void attribute(const std::string& name, const std::string& value, const std::string& object = "/");

  /// Writes the file under its final name. Nothing may be added after.
  /// \param front  makes the bytes for the free ones in front, as many as they are, from the bytes behind them
  void commit(const std::function<std::string(std::string_view)>& front = {});

 private:
  void write_raw(const std::string& name, const void* values, std::size_t size, std::int64_t type,
                 const Extents& extents);
  void attribute_raw(const std::string& name, const void* value, std::int64_t type, const std::string& object);

  std::filesystem::path path_;
  int compression_;
  std::size_t front_;
  std::int64_t id_ = -1;
};

/// Existing HDF5 file, for reading. All functions throw FileError with the file, the object and the reason.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  const std::filesystem::path& path() const { return path_; }
  bool has(const std::string& name) const;  ///< whether a group or dataset exists
  bool has_attribute(const std::string& name, const std::string& object = "/") const;
  std::vector<std::string> names(const std::string& group) const;  ///< members of a group in alphabetical order
  Extents extents(const std::string& name) const;

  /// Whole datasets, C order; numbers are converted to the type asked for.
  std::vector<double> doubles(const std::string& name) const;
  std::vector<std::int64_t> integers(const std::string& name) const;
  std::vector<unsigned char> bytes(const std::string& name) const;
  /// Reads a dataset into existing storage. \throws FileError also if the sizes differ
  void read(const std::string& name, std::span<double> values) const;

  double real_attribute(const std::string& name, const std::string& object = "/") const;
  std::int64_t integer_attribute(const std::string& name, const std::string& object = "/") const;
  std::string text_attribute(const std::string& name, const std::string& object = "/") const;

 private:
  /// Number of values of a dataset, where the file is large enough for them.
  std::size_t count_stored(const std::string& name, std::size_t value_bytes) const;
  void read_raw(const std::string& name, void* values, std::size_t size, std::int64_t type) const;
  void attribute_raw(const std::string& name, void* value, std::int64_t type, const std::string& object) const;

  std::filesystem::path path_;
  std::int64_t id_ = -1;
};

}  // namespace quicksand
