#include "app/initial_bubbles.hpp"

#include <algorithm>

#include "core/errors.hpp"

namespace quicksand {

namespace {

/// Lengths below this part of the domain's height are rounding.
constexpr double rounding = 1e-9;

/// Gaps in the liquid above a charge that are thinner than this part of the domain's height may be missed.
constexpr int samples = 4000;

/// The vertical line through a point, just inside the domain.
class VerticalLine {
 public:
  VerticalLine(const CaseConfig& config, const Vec<3>& point)
      : config_(config), geometry_(geometry_of(config.grid)), domain_(domain_of(config.grid)), point_(point) {
    for (int d = 0; d < 2; ++d) {
      // Shapes do not contain their own sides, and many end at a plane of symmetry.
      const double shift = rounding * (domain_.high[d] - domain_.low[d]);
      point_[d] += point_[d] + shift < domain_.high[d] ? shift : -shift;
    }
  }

  double tolerance() const { return rounding * (domain_.high[2] - domain_.low[2]); }
  double top() const { return domain_.high[2]; }

  /// The fill at a height, or nothing in gas.
  const InitialFill* fill_at(double z) const {
    Vec<3> point = point_;
    point[2] = z;
    const auto found = std::find_if(config_.initial.begin(), config_.initial.end(),
                                    [&](const InitialFill& fill) { return contains(fill.shape, point, geometry_); });
    return found == config_.initial.end() ? nullptr : &*found;
  }

  /// Whether there is liquid at a height; surfaces at which two fills meet count.
  bool covered(double z) const { return fill_at(z - tolerance()) != nullptr || fill_at(z + tolerance()) != nullptr; }

  /// Where the liquid that begins at a height ends, going up. \pre covered(z)
  double surface_above(double z) const {
    double low = z;
    double high = z;
    for (int k = 1; k <= samples && covered(high); ++k) {
      low = high;
      high = z + (top() - z) * k / samples;
    }
    if (covered(high)) return top();
    for (;;) {
      const double middle = low + (high - low) / 2;
      if (middle <= low || middle >= high) return std::max(z, low - tolerance());
      (covered(middle) ? low : high) = middle;
    }
  }

 private:
  const CaseConfig& config_;
  Geometry geometry_;
  Extent domain_;
  Vec<3> point_;
};

}  // namespace

PlacedCharge place_charge(const CaseConfig& config, const InitialCharge& charge) {
  const VerticalLine line(config, charge.center);
  const double z = charge.center[2];
  if (!line.covered(z)) throw InputError("must lie in liquid: no fill holds its middle");
  const double surface = line.surface_above(z);
  const InitialFill* topmost = line.fill_at(surface - 2 * line.tolerance());
  if (topmost == nullptr) topmost = line.fill_at(z - line.tolerance());  // right at the surface
  const std::optional<SideConfig>& top = config.boundaries.z_max;
  const bool liquid_outside = surface == line.top() && top && top->kind == SideKind::open && top->outside;

  PlacedCharge placed;
  placed.depth = surface - z;
  placed.density = config.species[species_number(config, topmost->fill)].density;
  placed.p_inf =
      (liquid_outside ? top->pressure : config.ambient_pressure) - placed.density * config.gravity[2] * placed.depth;
  placed.bubble = explosion_bubble({.mass = charge.mass / charge.thickness.value_or(1),
                                    .radius_constant = charge.radius_constant,
                                    .minimum_radius_constant = charge.minimum_radius_constant,
                                    .exponent = charge.adiabatic_exponent},
                                   placed.p_inf, geometry_of(config.grid));
  return placed;
}

std::vector<InitialBubble> initial_bubbles(const CaseConfig& config) {
  std::vector<InitialBubble> bubbles = config.bubbles;
  for (const InitialCharge& charge : config.charges) {
    const ExplosionBubble bubble = place_charge(config, charge).bubble;
    bubbles.push_back({charge.center, bubble.minimum_radius, bubble.initial_pressure, charge.adiabatic_exponent});
  }
  return bubbles;
}

}  // namespace quicksand
