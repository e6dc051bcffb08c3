#pragma once
/// \file
/// Names and symbols of units. The only unit that uses UDUNITS-2.
#include <string>

#include "core/units.hpp"

namespace quicksand {

/// A unit by its symbol or name with or without a prefix, such as `psi`, `inch`, `mm`, `kPa`, from the database of
/// UDUNITS-2 and a few additions (P, psf, mph ...). The database is read at the first call, in some milliseconds.
/// \param word  letters, digits and underscores, not beginning with a digit
/// \throws InputError if the unit is not known, or is more than a multiple of mass, length and time
/// \throws FileError if the database cannot be read
Unit find_unit(const std::string& word);

}  // namespace quicksand
