#pragma once
/// \file
/// Vectors of the mixture, such as its velocity, moved from one grid to another with their momentum.
#include "core/domain.hpp"
#include "physics/species_parts.hpp"

namespace quicksand {

/// Masses that the cells of one grid give to those of another.
template <int Dim>
class MassMap {
 public:
  /// All arguments must outlive this. \param total, rho  sum phi and density of the source, one ghost layer
  MassMap(const SpeciesParts<Dim>& parts, const GridOverlap<Dim>& overlap, const std::vector<Species>& species,
          const CellField& total, const CellField& rho);

  /// Mass of a part.
  double mass(const GridPart<Dim>& part) const;
  /// Moves a vector: momentum is conserved, every value lies among those that were there (so neither the largest
  /// magnitude nor a uniform vector changes), smooth vectors come out at second order.
  ///
  /// In a cell the vector is linear, q + S (x - x_m) about the cell's centre of mass, with limited slopes S, none
  /// beside empty cells, all scaled such that no part's magnitude exceeds the largest one in the cell and its
  /// neighbours.
  /// \param q       source, one ghost layer
  /// \param mapped  result in owned cells; zero where there is no mass
  void map(const CellVectors<Dim>& q, CellVectors<Dim>& mapped) const;

 private:
  Vec<Dim> deviation(const CellVectors<Dim>& q, const GridPart<Dim>& part) const;

  const SpeciesParts<Dim>& parts_;
  const GridOverlap<Dim>& overlap_;
  const std::vector<Species>& species_;
  const CellField& total_;
  const CellField& rho_;
  CellVectors<Dim> centre_;  ///< of mass, as the parts have it
};

/// Exchanges momentum between neighbours, mass-weighted and without raising any magnitude, until the kinetic energy is
/// at most `limit`: the vectors of refined cells vary within what was one cell, and the mean of their squares exceeds
/// the square of their mean by as much.
/// What is too much after many exchanges is taken from all deviations from the mean velocity.
/// \param u  owned cells
template <int Dim>
void lower_kinetic_energy(const Domain<Dim>& domain, const CellField& rho, double limit, CellVectors<Dim>& u);

extern template class MassMap<2>;
extern template class MassMap<3>;

}  // namespace quicksand
