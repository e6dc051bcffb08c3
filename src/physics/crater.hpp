#pragma once
/// \file
/// The crater in a bed in numbers.
#include "physics/bed_profile.hpp"

namespace quicksand {

/// Measures of a crater with respect to the level of the undisturbed bed. A bed without a crater has zeros.
template <int Dim>
struct Crater {
  double depth = 0;          ///< of the deepest column's surface below the level
  Vec<Dim - 1> deepest;      ///< where that column is
  Vec<Dim - 1> width;        ///< along x (and y) between the surface's crossings of the level
  double volume = 0;         ///< below the level, down to the surface
  double covered = 0;        ///< share of the crater's plan area under sand that overhangs it
  double lip_height = 0;     ///< of the highest column's surface above the level
  Vec<Dim - 1> lip;          ///< where that column is
  double volume_of_lip = 0;  ///< above the level, up to the surface
};

/// Height that half of a bed's plan area stays below: the level of a flat bed, whatever the charge has cut out of it.
template <int Dim>
double median_height(const BedProfile<Dim>& profile);

/// Measures the crater of a profile.
///
/// The width along an axis is the distance between the outermost crossings of the level, interpolated between columns,
/// that belong to anything deeper than a tenth of the depth, over all rows of columns along that axis. So that the
/// width does not hang on a level that the bed around the crater holds by chance, crossings are sought a quarter of a
/// cell lower, but not lower than a twentieth of the depth. A crater that reaches a side of the domain ends there; one
/// less deep than a hundredth of a cell has no width. An axis or plane of symmetry is taken to run through the middle
/// of the crater: width and volumes are those of the crater with its image.
template <int Dim>
Crater<Dim> measure_crater(const BedProfile<Dim>& profile, double level);

}  // namespace quicksand
