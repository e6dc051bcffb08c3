#pragma once
/// \file
/// Constitutive laws: the effective viscosity f of (42), T = f(phi, Delta) Delta, with the scalar strain rate
/// s = sqrt(1/2 Delta:Delta).
#include <cmath>
#include <variant>

namespace quicksand {

/// T = 0.
struct Inviscid {};

/// T = mu Delta, report (31).
struct Newtonian {
  double viscosity = 0;
};

/// T = {mu0 + tau_y / s} Delta where s > 0, |T| <= tau_y where s = 0, report (35): rigid below the yield stress.
struct Bingham {
  double viscosity = 0;
  double yield_stress = 0;
};

/// T = {mu0 + tau_y [1 - exp(-alpha s)] / s} Delta, report (36); alpha = 0 is Newtonian.
struct Papanastasiou {
  double viscosity = 0;
  double yield_stress = 0;
  double regularization = 0;  ///< alpha of (36), a time
};

/// T = {K (s^2 + delta^2)^((n-1)/2) + tau_y [1 - exp(-alpha s)] / s} Delta: Herschel and Bulkley's law regularised as
/// in (36). delta = thinning_cutoff / alpha makes f finite at rest for n < 1 and is 0 for n >= 1.
struct HerschelBulkley {
  double consistency = 0;  ///< K, Pa s^n
  double index = 1;        ///< n > 0
  double yield_stress = 0;
  double regularization = 0;  ///< alpha, a time; > 0 for n < 1
};

/// sqrt|T| = sqrt(mu s) + sqrt(tau_y) [1 - exp(-sqrt(alpha s))]: Casson's law regularised like (36) in the roots.
struct Casson {
  double viscosity = 0;
  double yield_stress = 0;
  double regularization = 0;  ///< alpha, a time
};

/// delta alpha of HerschelBulkley. The stress is K s^n within a per cent down to a tenth of 1/alpha, where the yield
/// stress has long been smoothed away.
inline constexpr double thinning_cutoff = 0.01;

using Law = std::variant<Inviscid, Newtonian, Bingham, Papanastasiou, HerschelBulkley, Casson>;

/// Parameters of f at one place in the mixture: a sum of one term of each kind.
struct Rheology {
  double viscosity = 0;     ///< mu
  double yield_stress = 0;  ///< of the term tau_y [1 - exp(-alpha s)] / s
  double regularization = 0;
  double consistency = 0;  ///< of the term K (s^2 + cutoff^2)^((index - 1)/2)
  double index = 1;
  double cutoff = 0;
  double casson_yield_stress = 0;  ///< of the term tau_y [1 - exp(-x)]^2 / s, x = sqrt(alpha s)
  double casson_cross = 0;         ///< 2 sqrt(mu tau_y), of the term [1 - exp(-x)] / sqrt(s)
  double casson_regularization = 0;
  double rigid_yield_stress = 0;  ///< of Bingham's law; not part of f, see viscous_functional.hpp

  /// Whether a stress acts at any strain rate.
  bool carries_stress() const;
  /// Whether f depends on the strain rate, the rigid yield stress apart.
  bool is_nonlinear() const { return yield_stress > 0 || consistency > 0 || casson_yield_stress > 0; }
  /// Yield stresses of the regularised terms together.
  double regularised_yield_stress() const { return yield_stress + casson_yield_stress; }
};

/// Parameters of a pure species.
Rheology rheology(const Law& law);

/// Adds up terms of one kind with weights: amounts add, exponents are means weighted by amounts.
class RheologySum {
 public:
  /// \param viscous, plastic  factors of viscosities and consistencies, and of yield stresses
  void add(const Rheology& part, double viscous, double plastic);
  Rheology result() const;

 private:
  Rheology total_;  // with amounts times exponents in place of the exponents
};

/// f, its derivative and the dissipation potential at one strain rate, without the rigid yield stress.
struct LawValue {
  double f;              ///< effective viscosity
  double plastic;        ///< the part of f that falls with s: yield stresses and shear thinning
  double slope;          ///< f'(s); 0 at s = 0 where it has no limit
  double plastic_slope;  ///< derivative of `plastic`, <= 0
  double potential;      ///< integral of f s ds from 0 to s
};

/// Adds the terms of Herschel-Bulkley and Casson laws.
void add_power_law(const Rheology& m, double s, LawValue& value);
void add_casson(const Rheology& m, double s, LawValue& value);

/// All of LawValue, to round-off for any s >= 0.
inline LawValue evaluate(const Rheology& m, double s) {
  const double a = m.regularization;
  const double x = a * s;
  const double b = m.yield_stress * a;
  const double newtonian = 0.5 * m.viscosity * s * s;
  LawValue value;
  if (x < 1e-3) {
    // (1-e^-x)/x = 1 - x/2 + x^2/6 - x^3/24; derivative and integral term by term.
    value.plastic = b * (1 - x * (0.5 - x * (1.0 / 6 - x / 24)));
    value.plastic_slope = b * a * (-0.5 + x * (1.0 / 3 - x / 8));
    value.potential = newtonian + b * s * s * (0.5 - x * (1.0 / 6 - x / 24));
  } else {
    const double decayed = -std::expm1(-x);  // 1 - e^-x
    value.plastic = m.yield_stress * decayed / s;
    value.plastic_slope = m.yield_stress * (a * (1 - decayed) - decayed / s) / s;
    value.potential = newtonian + m.yield_stress * (s - decayed / a);
  }
  value.f = m.viscosity + value.plastic;
  value.slope = value.plastic_slope;
  if (m.consistency > 0) add_power_law(m, s, value);
  if (m.casson_yield_stress > 0) add_casson(m, s, value);
  return value;
}

/// f(s), to round-off for any s >= 0.
inline double effective_viscosity(const Rheology& m, double s) { return evaluate(m, s).f; }

}  // namespace quicksand
