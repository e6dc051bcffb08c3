#pragma once
/// \file
/// The surface of a bed: how high a species stands in every column of cells.
#include <array>
#include <vector>

#include "core/domain.hpp"

namespace quicksand {

/// One horizontal axis of a profile.
struct ProfileAxis {
  std::vector<double> centre;  ///< of the columns
  double low = 0, high = 0;    ///< ends of the domain
  bool mirrored_low = false;   ///< whether the end is an axis or a plane of symmetry
  bool mirrored_high = false;
};

/// Heights of a bed over its plan. Columns are numbered with x fastest.
///
/// A cell belongs to the bed where the species fills more than half of it, so that spray and what is suspended do not
/// count. Between the topmost cell of bed and the cell above it the surface lies where the fractions of both, piled up
/// from below, reach: exact for a plane that rises by at most a cell from column to column.
template <int Dim>
struct BedProfile {
  std::array<ProfileAxis, static_cast<std::size_t>(Dim - 1)> axes;
  /// Where the bed ends on the way up from the ground: the floor of a cavity that sand covers. A gap of a single cell
  /// is passed over, for a bed that closes catches gas in such gaps.
  std::vector<double> surface;
  /// Where the bed ends on the way down from above, over all cells that hang together with the ground by their faces.
  /// Above `surface` where the bed overhangs; blobs that have come off do not count.
  std::vector<double> top;
  /// Plan area of each column: of the whole circle in axisymmetric domains, and with its images beyond planes of
  /// symmetry.
  std::vector<double> area;
  double resolution = 0;  ///< height of the smallest cell
};

/// Profile of a species.
/// \param phi  its volume fraction on the owned cells \pre the grid owns its whole domain
template <int Dim>
BedProfile<Dim> bed_profile(const Domain<Dim>& domain, const CellField& phi);

}  // namespace quicksand
