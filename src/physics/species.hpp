#pragma once
/// \file
/// What a species is made of.
#include <string>

#include "physics/laws.hpp"

namespace quicksand {

/// Exponents kappa of (43b), for viscosity and yield stress; 0 means linear in the fraction.
struct Concentration {
  double viscosity_exponent = 0;
  double yield_exponent = 0;
};

/// One incompressible species. The order of species is the order of the successive constraint (25).
struct Species {
  std::string name;
  double density = 1;
  Law law;
  Concentration concentration;
};

}  // namespace quicksand
