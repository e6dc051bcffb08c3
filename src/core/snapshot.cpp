#include "core/snapshot.hpp"

#include <algorithm>

#include "core/errors.hpp"
#include "core/hdf5_file.hpp"

namespace quicksand {

namespace {

/// Version of the layout described in the header; readers of later layouts can tell by it.
constexpr std::int64_t format_version = 1;

/// Cells along the axes, slowest first as in the file.
Extents cell_extents(const std::vector<SnapshotAxis>& axes) {
  Extents extents;
  for (auto axis = axes.rbegin(); axis != axes.rend(); ++axis) extents.push_back(axis->faces.size() - 1);
  return extents;
}

/// Vectors of two components with a zero third one.
std::vector<double> padded_to_three(const std::vector<double>& values) {
  std::vector<double> padded;
  padded.reserve(values.size() / 2 * 3);
  for (std::size_t n = 0; n + 1 < values.size(); n += 2) padded.insert(padded.end(), {values[n], values[n + 1], 0.0});
  return padded;
}

}  // namespace

std::string fields_file_name(std::int64_t step) {
  const std::string digits = std::to_string(step);
  const std::size_t width = 8;
  return "fields_" + std::string(width > digits.size() ? width - digits.size() : 0, '0') + digits + ".h5";
}

std::string geometry_name(Geometry geometry) {
  switch (geometry) {
    case Geometry::planar: return "planar";
    case Geometry::axisymmetric: return "axisymmetric";
    case Geometry::cartesian: return "cartesian";
  }
  return {};
}

void write_fields(const std::filesystem::path& path, const FieldSnapshot& snapshot, int compression) {
  const Extents cells = cell_extents(snapshot.axes);
  Hdf5Writer file(path, compression);
  file.attribute("format_version", format_version);
  file.attribute("title", snapshot.title);
  file.attribute("units", snapshot.units);
  file.attribute("geometry", snapshot.geometry);
  file.attribute("step", snapshot.step);
  file.attribute("time", snapshot.time);
  file.attribute("dt", snapshot.dt);
  for (const SnapshotAxis& axis : snapshot.axes) file.write("grid/" + axis.name, axis.faces);
  for (const SnapshotField& field : snapshot.fields) {
    Extents extents = cells;
    if (field.components > 1) extents.push_back(static_cast<std::size_t>(field.components));
    if (field.values.size() != count(extents)) {
      throw FileError(path.string() + ": field '" + field.name + "' has " + std::to_string(field.values.size()) +
                      " values, its grid takes " + std::to_string(count(extents)));
    }
    file.write("fields/" + field.name, field.values, extents);
    if (field.components == 2) {
      extents.back() = 3;
      file.write("viewer/" + field.name, padded_to_three(field.values), extents);
    }
  }
  file.commit();
}

FieldSnapshot read_fields(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  FieldSnapshot snapshot;
  snapshot.title = file.text_attribute("title");
  snapshot.units = file.text_attribute("units");
  snapshot.geometry = file.text_attribute("geometry");
  snapshot.step = file.integer_attribute("step");
  snapshot.time = file.real_attribute("time");
  snapshot.dt = file.real_attribute("dt");
  const auto refuse = [&](const std::string& name, const std::string& why) {
    throw FileError(path.string() + ": '" + name + "' " + why);
  };
  // The names of the axes sort as x, y, z.
  for (const std::string& name : file.names("grid")) {
    snapshot.axes.push_back({name, file.doubles("grid/" + name)});
    if (snapshot.axes.back().faces.size() < 2) refuse("grid/" + name, "has no cells");
  }
  const Extents cells = cell_extents(snapshot.axes);
  for (const std::string& name : file.names("fields")) {
    const Extents extents = file.extents("fields/" + name);
    const bool is_vector = extents.size() == cells.size() + 1;
    if (extents.size() < cells.size() || !std::equal(cells.begin(), cells.end(), extents.begin()) ||
        (extents.size() > cells.size() && !is_vector)) {
      refuse("fields/" + name, "does not fit the grid");
    }
    snapshot.fields.push_back({name, is_vector ? static_cast<int>(extents.back()) : 1, file.doubles("fields/" + name)});
  }
  return snapshot;
}

template <int Dim>
std::vector<SnapshotAxis> snapshot_axes(const Grid<Dim>& grid) {
  std::vector<SnapshotAxis> axes;
  const std::string names = Dim == 2 ? "xz" : "xyz";
  for (int d = 0; d < Dim; ++d)
    axes.push_back({std::string(1, names[static_cast<std::size_t>(d)]), grid.global_faces(d)});
  return axes;
}

template std::vector<SnapshotAxis> snapshot_axes(const Grid<2>&);
template std::vector<SnapshotAxis> snapshot_axes(const Grid<3>&);

}  // namespace quicksand
