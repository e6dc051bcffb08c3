#pragma once
/// \file
/// What is measured of the bubbles of a flow.
#include <vector>

#include "physics/flow.hpp"

namespace quicksand {

/// A bubble in numbers. The volume is that of the modelled part, of the whole circle in axisymmetric flows.
template <int Dim>
struct BubbleMeasures {
  int id;
  double volume;
  double pressure;
  Vec<Dim> centroid;  ///< of the modelled part; 0 along the radius in axisymmetric flows
  double width;       ///< largest length of gas along x over all rows of cells of the modelled part
};

/// Measures the bubbles from all gas that counts for them (label_gas()), by increasing id.
template <int Dim>
std::vector<BubbleMeasures<Dim>> measure_bubbles(const Flow<Dim>& flow);

/// Ids of the gas regions for output: 0 in D, open_air where gas has the ambient pressure, else the bubble's.
template <int Dim>
CellField gas_region_field(const Flow<Dim>& flow);

}  // namespace quicksand
