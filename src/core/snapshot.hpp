#pragma once
/// \file
/// Field files: what `fields_<step>.h5` holds.
///
/// Layout: `/grid/<axis>` face coordinates; `/fields/<name>` values in C order with x fastest, so extents are [z][x] or
/// [z][y][x], and for vectors the components as one more, last axis. Root attributes: title, units, geometry, step,
/// time, dt. `/viewer/<name>` repeats vectors of two components with a zero third one, without which ParaView and VisIt
/// don't take them for vectors.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/grid.hpp"

namespace quicksand {

/// Face coordinates along one axis.
struct SnapshotAxis {
  std::string name;  ///< "x", "y" or "z"; the radius is "x"
  std::vector<double> faces;
};

/// Values of one field on the cells, x fastest; the components of a vector stand side by side.
struct SnapshotField {
  std::string name;
  int components = 1;
  std::vector<double> values;
};

/// Everything in a field file.
struct FieldSnapshot {
  std::string title;
  std::string units;     ///< "SI" or "none"
  std::string geometry;  ///< "planar", "axisymmetric" or "cartesian"
  std::int64_t step = 0;
  double time = 0;
  double dt = 0;
  std::vector<SnapshotAxis> axes;  ///< x first
  std::vector<SnapshotField> fields;
};

/// Name of the field file of a step: fields_00001200.h5. Names sort by step.
std::string fields_file_name(std::int64_t step);

/// Writes a field file, complete or not at all.
/// \param compression  deflate level 0 ... 9
/// \throws FileError; also where the number of values of a field does not fit the axes
void write_fields(const std::filesystem::path& path, const FieldSnapshot& snapshot, int compression = 1);

/// Reads a field file back. \throws FileError
FieldSnapshot read_fields(const std::filesystem::path& path);

/// Axes named x, (y,) z with the face coordinates of the whole domain.
template <int Dim>
std::vector<SnapshotAxis> snapshot_axes(const Grid<Dim>& grid);

/// Name of a geometry as field files and configs write it.
std::string geometry_name(Geometry geometry);

namespace detail {

/// Calls body(first cell, length) for every row of owned cells in the order of a field file.
template <int Dim, class Body>
void for_each_owned_row(const Grid<Dim>& grid, Body&& body) {
  const Box<Dim> cells = grid.cells();
  const Rows<Dim> rows(grid.layout(), cells);
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) body(Cell{rows.start(r)}, rows.length);
}

}  // namespace detail

/// Values of the owned cells, x fastest, without ghost layers.
template <int Dim, class T>
std::vector<T> owned_values(const Grid<Dim>& grid, const Field<Cell, T>& field) {
  std::vector<T> values(static_cast<std::size_t>(grid.cells().size()));
  auto next = values.begin();
  detail::for_each_owned_row(grid, [&](Cell start, int length) {
    for (int i = 0; i < length; ++i) *next++ = field[start + i * grid.step(0)];
  });
  return values;
}

/// Vectors of the owned cells, components side by side.
template <int Dim>
std::vector<double> owned_values(const Grid<Dim>& grid, const CellVectors<Dim>& field) {
  std::vector<double> values(static_cast<std::size_t>(grid.cells().size()) * Dim);
  auto next = values.begin();
  detail::for_each_owned_row(grid, [&](Cell start, int length) {
    for (int i = 0; i < length; ++i) {
      for (int d = 0; d < Dim; ++d) *next++ = field[d][start + i * grid.step(0)];
    }
  });
  return values;
}

}  // namespace quicksand
