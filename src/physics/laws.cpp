#include "physics/laws.hpp"

namespace quicksand {

namespace {

struct ToRheology {
  Rheology operator()(const Inviscid&) const { return {}; }
  Rheology operator()(const Newtonian& law) const { return {.viscosity = law.viscosity}; }
  Rheology operator()(const Bingham& law) const {
    return {.viscosity = law.viscosity, .rigid_yield_stress = law.yield_stress};
  }
  Rheology operator()(const Papanastasiou& law) const {
    return {.viscosity = law.viscosity, .yield_stress = law.yield_stress, .regularization = law.regularization};
  }
  Rheology operator()(const HerschelBulkley& law) const {
    if (law.index == 1) return (*this)(Papanastasiou{law.consistency, law.yield_stress, law.regularization});
    return {.yield_stress = law.yield_stress,
            .regularization = law.regularization,
            .consistency = law.consistency,
            .index = law.index,
            .cutoff = law.index < 1 ? thinning_cutoff / law.regularization : 0.0};
  }
  Rheology operator()(const Casson& law) const {
    return {.viscosity = law.viscosity,
            .casson_yield_stress = law.yield_stress * (law.regularization > 0 ? 1 : 0),
            .casson_cross = 2 * std::sqrt(law.viscosity * law.yield_stress),
            .casson_regularization = law.regularization};
  }
};

/// Integrals over x of x^2 (1 - e^-x) and x (1 - e^-x)^2 from 0.
struct CassonIntegrals {
  double cross;
  double yield;

  explicit CassonIntegrals(double x) : cross(0), yield(0) {
    if (x < 0.5) {
      // Term by term: the closed forms cancel.
      double term = -1;  // (-x)^k / k!, sign turned
      double two = 1;
      for (int k = 1; k <= 16; ++k) {
        term *= -x / k;
        two *= 2;
        cross += term / (k + 3);
        yield -= term * (two - 2) / (k + 2);
      }
      cross *= x * x * x;
      yield *= x * x;
    } else {
      const double e = std::exp(-x);
      cross = x * x * x / 3 - 2 + e * (x * (x + 2) + 2);
      yield = x * x / 2 - 2 * (1 - (1 + x) * e) + 0.25 * (1 - (1 + 2 * x) * e * e);
    }
  }
};

}  // namespace

Rheology rheology(const Law& law) { return std::visit(ToRheology{}, law); }

bool Rheology::carries_stress() const {
  return viscosity > 0 || yield_stress * regularization > 0 || consistency > 0 || casson_yield_stress > 0 ||
         rigid_yield_stress > 0;
}

void RheologySum::add(const Rheology& part, double viscous, double plastic) {
  total_.viscosity += viscous * part.viscosity;
  total_.yield_stress += plastic * part.yield_stress;
  total_.regularization += plastic * part.yield_stress * part.regularization;
  total_.consistency += viscous * part.consistency;
  total_.index += viscous * part.consistency * part.index;
  total_.cutoff += viscous * part.consistency * part.cutoff;
  total_.casson_yield_stress += plastic * part.casson_yield_stress;
  total_.casson_cross += std::sqrt(viscous * plastic) * part.casson_cross;
  total_.casson_regularization += plastic * part.casson_yield_stress * part.casson_regularization;
  total_.rigid_yield_stress += plastic * part.rigid_yield_stress;
}

Rheology RheologySum::result() const {
  Rheology mean = total_;
  mean.regularization = total_.yield_stress > 0 ? total_.regularization / total_.yield_stress : 0.0;
  mean.index = total_.consistency > 0 ? (total_.index - 1) / total_.consistency : 1.0;
  mean.cutoff = total_.consistency > 0 ? total_.cutoff / total_.consistency : 0.0;
  mean.casson_regularization =
      total_.casson_yield_stress > 0 ? total_.casson_regularization / total_.casson_yield_stress : 0.0;
  return mean;
}

void add_power_law(const Rheology& m, double s, LawValue& value) {
  const double n = m.index;
  double f;
  double slope = 0;
  if (m.cutoff > 0) {
    const double square = s * s + m.cutoff * m.cutoff;
    const double ratio = s / m.cutoff;
    f = m.consistency * std::pow(square, 0.5 * (n - 1));
    slope = f * (n - 1) * s / square;
    value.potential +=
        m.consistency * std::pow(m.cutoff, n + 1) * std::expm1(0.5 * (n + 1) * std::log1p(ratio * ratio)) / (n + 1);
  } else {
    f = m.consistency * std::pow(s, n - 1);
    slope = s > 0 ? f * (n - 1) / s : 0.0;
    value.potential += f * s * s / (n + 1);
  }
  value.f += f;
  value.slope += slope;
  if (n < 1) {
    value.plastic += f;
    value.plastic_slope += slope;
  }
}

void add_casson(const Rheology& m, double s, LawValue& value) {
  const double a = m.casson_regularization;
  const double x = std::sqrt(a * s);
  // q = (1 - e^-x) / x and its derivative.
  double q;
  double dq;
  if (x < 1e-3) {
    q = 1 - x * (0.5 - x * (1.0 / 6 - x / 24));
    dq = -0.5 + x * (1.0 / 3 - x * (1.0 / 8 - x / 30));
  } else {
    const double decayed = -std::expm1(-x);
    q = decayed / x;
    dq = (1 - decayed - q) / x;
  }
  const double root = std::sqrt(a);
  const double f = m.casson_cross * root * q + m.casson_yield_stress * a * q * q;
  const double df = m.casson_cross * root * dq + 2 * m.casson_yield_stress * a * q * dq;
  const double slope = x > 0 ? df * a / (2 * x) : 0.0;
  const CassonIntegrals integral(x);
  value.f += f;
  value.plastic += f;
  value.slope += slope;
  value.plastic_slope += slope;
  value.potential += 2 * m.casson_cross * integral.cross / (a * root) + 2 * m.casson_yield_stress * integral.yield / a;
}

}  // namespace quicksand
