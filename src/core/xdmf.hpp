#pragma once
/// \file
/// `fields.xdmf`: the field files of a run as a time series for ParaView and VisIt.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace quicksand {

/// What the series tells about one field file; the values stay in that file.
struct XdmfEntry {
  struct Axis {
    std::string name;
    std::size_t points;
  };
  struct Array {
    std::string name;
    std::size_t components;
  };
  std::string file;  ///< name of the field file, in the same folder
  std::int64_t step = 0;
  double time = 0;
  std::vector<Axis> axes;  ///< x first
  std::vector<Array> fields;
};

/// Reads the entry of a field file. \throws FileError
XdmfEntry xdmf_entry(const std::filesystem::path& field_file);

/// The XML of a series. A planar or axisymmetric grid (x, z) lies in the viewer's x-y plane, so that it opens face on
/// with z upwards.
std::string xdmf_text(const std::vector<XdmfEntry>& entries);

/// Keeps `fields.xdmf` in step with the field files of a result folder.
class XdmfSeries {
 public:
  /// Starts from the field files that are in the folder already: those of a run that is resumed.
  explicit XdmfSeries(std::filesystem::path folder);

  /// Adds a field file of the folder and rewrites `fields.xdmf`. \throws FileError
  void add(const std::filesystem::path& field_file);
  /// Writes `fields.xdmf` as it stands. \throws FileError
  void write() const;
  const std::vector<XdmfEntry>& entries() const { return entries_; }

 private:
  void insert(const XdmfEntry& entry);

  std::filesystem::path folder_;
  std::vector<XdmfEntry> entries_;  ///< by step
};

}  // namespace quicksand
