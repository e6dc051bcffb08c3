#pragma once
/// \file
/// Preconditioned conjugate gradients on fields, for any operator and preconditioner given as callables.
#include <cmath>
#include <string_view>

#include "core/field.hpp"
#include "core/layout.hpp"
#include "core/loop.hpp"

namespace quicksand {

/// When a linear solve stops: |b - A x| <= max(relative |b|, absolute), in the norm of the solver.
struct Tolerance {
  double relative = 1e-8;
  double absolute = 0;
  int max_iterations = 200;
};

/// What became of a linear solve.
struct SolveReport {
  bool converged = false;
  int iterations = 0;
  double residual = 0;  ///< true residual |b - A x| / |b| of the x returned (0 if b = 0 and x = 0)
  std::string_view method = "cg";
};

/// Fields that make up a vector of unknowns: one scalar field, or the components of a vector field.
template <class At>
constexpr int part_count(const Field<At>&) {
  return 1;
}
template <int Dim, class At>
constexpr int part_count(const Components<Dim, At>&) {
  return Dim;
}
template <class At>
Field<At>& part(Field<At>& x, int) {
  return x;
}
template <class At>
const Field<At>& part(const Field<At>& x, int) {
  return x;
}
template <int Dim, class At>
Field<At>& part(Components<Dim, At>& x, int k) {
  return x[k];
}
template <int Dim, class At>
const Field<At>& part(const Components<Dim, At>& x, int k) {
  return x[k];
}

/// Inner product over the box, all parts.
template <class At, int Dim, class Vector>
double dot(const Layout<Dim>& layout, const Box<Dim>& box, const Vector& x, const Vector& y) {
  return sum<At>(layout, box, [&](At p) {
    double product = 0;
    for (int k = 0; k < part_count(x); ++k) product += part(x, k)[p] * part(y, k)[p];
    return product;
  });
}

/// Calls body(y(p), x(p)) for all points of the box and all parts; the body updates its first argument.
template <class At, int Dim, class Vector, class Body>
void combine(const Layout<Dim>& layout, const Box<Dim>& box, Vector& y, const Vector& x, Body&& body) {
  for_each<At>(layout, box, [&](At p) {
    for (int k = 0; k < part_count(y); ++k) body(part(y, k)[p], part(x, k)[p]);
  });
}

/// Euclidean norm over all unknowns of the box.
template <class At, int Dim>
struct EuclideanNorm {
  const Layout<Dim>& layout;
  const Box<Dim>& box;
  template <class Vector>
  double operator()(const Vector& x) const {
    return std::sqrt(dot<At>(layout, box, x, x));
  }
};

/// Conjugate gradients from an x with the residual r, until norm(r) is at most `target` or an iteration can't be done.
///
/// \param sign    x goes by `sign` times the steps: -1 where r is A x - b
/// \param r       on the box; follows by recursion, so that round-off parts it from the true residual
/// \param p, z    work vectors, zero around the box
/// \param report  its iterations grow, to at most max_iterations
/// \returns the norm of r
template <class At, int Dim, class Vector, class Apply, class Precondition, class Norm>
double descend(const Layout<Dim>& layout, const Box<Dim>& box, Apply&& apply, Precondition&& precondition, double sign,
               Vector& r, Vector& x, Vector& p, Vector& z, double target, int max_iterations, Norm&& norm,
               SolveReport& report) {
  Vector& q = z;  // neither is there when the other is
  double r_norm = norm(r);
  double rz_old = 0;
  while (r_norm > target && report.iterations < max_iterations) {
    precondition(r, z);
    const double rz = dot<At>(layout, box, r, z);
    if (!(rz > 0) || !std::isfinite(rz)) break;
    const double beta = rz_old > 0 ? rz / rz_old : 0;
    combine<At>(layout, box, p, z, [beta](double& pi, double zi) { pi = zi + beta * pi; });
    apply(p, q);
    const double pq = dot<At>(layout, box, p, q);
    if (!(pq > 0) || !std::isfinite(pq)) break;
    const double alpha = rz / pq;
    for_each<At>(layout, box, [&, step = sign * alpha](At at) {
      for (int k = 0; k < part_count(x); ++k) {
        part(x, k)[at] += step * part(p, k)[at];
        part(r, k)[at] -= alpha * part(q, k)[at];
      }
    });
    r_norm = norm(r);
    rz_old = rz;
    ++report.iterations;
  }
  return r_norm;
}

/// Solves A x = b for a symmetric positive (semi-)definite operator, from the guess x.
///
/// \tparam At      Cell or Node
/// \tparam Vector  Field<At> or Components<Dim, At>
/// \param apply         apply(x, y): y = A x on the box; may write to x around the box
/// \param precondition  precondition(r, z): z ~ A^-1 r on the box, symmetric and positive definite
/// \param b             right-hand side on the box
/// \param x             guess on entry, the best solution found on return. Outside the box it is left alone; the
///                      work vectors are zero there, as if x had homogeneous boundary values
/// \param norm          norm(r) >= 0, in which residuals are measured; NaN for values that are not finite
/// \returns converged = false when the iterations run out, when the operator or preconditioner turns out not to be
/// positive
///          definite, or when a value is not finite; the residual is always that of the x returned
template <class At, int Dim, class Vector, class Apply, class Precondition, class Norm>
[[nodiscard]] SolveReport conjugate_gradients(const Layout<Dim>& layout, const Box<Dim>& box, Apply&& apply,
                                              Precondition&& precondition, const Vector& b, Vector& x,
                                              const Tolerance& tolerance, Norm&& norm) {
  SolveReport report;
  const double b_norm = norm(b);
  const double target = std::fmax(tolerance.relative * b_norm, tolerance.absolute);
  const double scale = b_norm > 0 ? b_norm : 1;
  if (!std::isfinite(b_norm)) {
    report.residual = b_norm;
    return report;
  }

  if (!(target > 0)) {
    // Nothing but x = 0 reaches such a target.
    combine<At>(layout, box, x, b, [](double& xi, double) { xi = 0; });
    report.converged = true;
    return report;
  }

  Vector r(layout), p(layout), z(layout);
  const auto update_residual = [&] {
    apply(x, r);
    combine<At>(layout, box, r, b, [](double& ri, double bi) { ri = bi - ri; });
    return norm(r);
  };
  double r_norm = update_residual();
  if (!std::isfinite(r_norm)) {
    // A useless guess must not spoil the solve.
    combine<At>(layout, box, x, b, [](double& xi, double) { xi = 0; });
    r_norm = update_residual();
  }
  // A second round runs only when the recursive residual drifted away from the true one.
  for (int round = 0; round < 3 && r_norm > target && report.iterations < tolerance.max_iterations; ++round) {
    descend<At>(layout, box, apply, precondition, 1.0, r, x, p, z, target, tolerance.max_iterations, norm, report);
    r_norm = update_residual();
  }
  report.residual = r_norm / scale;
  report.converged = r_norm <= target;
  return report;
}

/// The same in the Euclidean norm.
template <class At, int Dim, class Vector, class Apply, class Precondition>
[[nodiscard]] SolveReport conjugate_gradients(const Layout<Dim>& layout, const Box<Dim>& box, Apply&& apply,
                                              Precondition&& precondition, const Vector& b, Vector& x,
                                              const Tolerance& tolerance) {
  return conjugate_gradients<At>(layout, box, apply, precondition, b, x, tolerance,
                                 EuclideanNorm<At, Dim>{layout, box});
}

}  // namespace quicksand
