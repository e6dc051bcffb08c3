#pragma once
/// \file
/// The crater in a bed in numbers.
#include "physics/bed_profile.hpp"

namespace quicksand {

/// What lies below the level of the undisturbed bed. Zeros where nothing does.
template <int Dim>
struct Hollow {
  double depth = 0;      ///< of the deepest column below the level
  Vec<Dim - 1> deepest;  ///< where that column is
  Vec<Dim - 1> width;    ///< along x (and y) between crossings of the level
  double volume = 0;
};

/// Measures of a crater with respect to the level of the undisturbed bed.
template <int Dim>
struct Crater {
  Hollow<Dim> whole;         ///< down to BedProfile::surface, with cavities that sand covers
  Hollow<Dim> open;          ///< down to BedProfile::top: what can be seen from above
  double lip_height = 0;     ///< of the highest column's top above the level
  Vec<Dim - 1> lip;          ///< where that column is
  double volume_of_lip = 0;  ///< above the level, up to the top
};

/// Height that the tops of half of a bed's plan area stay below: the level of a flat bed, whatever the charge has cut
/// out of it.
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
