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

/// T = {mu0 + tau_y [1 - exp(-alpha s)] / s} Delta, report (36); alpha = 0 is Newtonian.
struct Papanastasiou {
  double viscosity = 0;
  double yield_stress = 0;
  double regularization = 0;  ///< alpha of (36), a time
};

using Law = std::variant<Inviscid, Newtonian, Papanastasiou>;

/// Parameters of f at one place in the mixture: every law above is a case of (36).
struct Rheology {
  double viscosity = 0;
  double yield_stress = 0;
  double regularization = 0;
};

/// Parameters of a pure species.
Rheology rheology(const Law& law);

/// f, its derivative and the dissipation potential at one strain rate.
struct LawValue {
  double f;          ///< effective viscosity
  double plastic;    ///< f less the viscosity mu: the part that the yield stress makes
  double slope;      ///< f'(s) <= 0
  double potential;  ///< integral of f s ds from 0 to s
};

/// f(s) = mu + tau_y (1 - exp(-alpha s)) / s, to round-off for any s >= 0.
inline double effective_viscosity(const Rheology& m, double s) {
  const double x = m.regularization * s;
  // (1 - e^-x) / x by its series where the quotient would cancel.
  const double ratio = x < 1e-5 ? 1 - x / 2 + x * x / 6 : -std::expm1(-x) / x;
  return m.viscosity + m.yield_stress * m.regularization * ratio;
}

/// All of LawValue, to round-off for any s >= 0.
inline LawValue evaluate(const Rheology& m, double s) {
  const double a = m.regularization;
  const double x = a * s;
  const double b = m.yield_stress * a;
  if (x < 1e-3) {
    // (1-e^-x)/x = 1 - x/2 + x^2/6 - x^3/24; derivative and integral term by term.
    const double plastic = b * (1 - x * (0.5 - x * (1.0 / 6 - x / 24)));
    const double slope = b * a * (-0.5 + x * (1.0 / 3 - x / 8));
    const double potential = 0.5 * m.viscosity * s * s + b * s * s * (0.5 - x * (1.0 / 6 - x / 24));
    return {m.viscosity + plastic, plastic, slope, potential};
  }
  const double decayed = -std::expm1(-x);  // 1 - e^-x
  const double plastic = m.yield_stress * decayed / s;
  const double slope = m.yield_stress * (a * (1 - decayed) - decayed / s) / s;
  const double potential = 0.5 * m.viscosity * s * s + m.yield_stress * (s - decayed / a);
  return {m.viscosity + plastic, plastic, slope, potential};
}

}  // namespace quicksand
