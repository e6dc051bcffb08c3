#pragma once
/// \file
/// Packs: a few numbers side by side that are computed with at once, in one register of the processor. Templates on a
/// type `Real` work on one number (double) or on a pack of them, with the same result in every lane, bit by bit. Sums
/// over the elements around a point may be taken in another order in packs.
#if defined(__AVX512F__) || defined(__FMA__)
#include <immintrin.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "core/field.hpp"

namespace quicksand {

#if defined(__AVX512F__)
inline constexpr int pack_width = 8;
#elif defined(__AVX__)
inline constexpr int pack_width = 4;
#else
inline constexpr int pack_width = 2;
#endif

/// Vector extension of g++ and clang: arithmetic lane by lane, also with plain numbers.
typedef double Pack __attribute__((vector_size(8 * pack_width)));  // NOLINT(modernize-use-using): g++ wants it so

/// How many numbers a Real holds.
template <class Real>
inline constexpr int lanes = sizeof(Real) / sizeof(double);

inline double lane(double x, int) { return x; }
inline double lane(const Pack& x, int l) { return x[l]; }
inline void set_lane(double& x, int, double value) { x = value; }
inline void set_lane(Pack& x, int l, double value) { x[l] = value; }

/// Whether a number other than 0 is among them.
inline bool any(double x) { return x != 0; }
inline bool any(const Pack& x) {
  bool found = false;
  for (int l = 0; l < pack_width; ++l) found = found || x[l] != 0;
  return found;
}

/// The numbers from a place in an array on.
inline Pack load_pack(const double* place) {
  Pack x;
  std::memcpy(&x, place, sizeof x);
  return x;
}
inline void store_pack(const Pack& x, double* place) { std::memcpy(place, &x, sizeof x); }

/// Values at a position and those that follow it along x.
template <class Real, class At>
Real load(const Field<At>& field, At at) {
  Real x;
  std::memcpy(&x, &field[at], sizeof(Real));
  return x;
}
/// Adds to the values at a position and those that follow it along x.
template <class Real, class At>
void add_to(Field<At>& field, At at, const Real& x) {
  const Real sum = load<Real>(field, at) + x;
  std::memcpy(&field[at], &sum, sizeof(Real));
}

inline double square_root(double x) { return std::sqrt(x); }
inline Pack square_root(const Pack& x) {
  Pack root;
  for (int l = 0; l < pack_width; ++l) root[l] = std::sqrt(x[l]);
  return root;
}

/// a - b c, rounded once where the processor can.
inline Pack minus_product(const Pack& a, double b, const Pack& c) {
#if defined(__AVX512F__)
  return _mm512_fnmadd_pd(_mm512_set1_pd(b), c, a);
#elif defined(__FMA__)
  return _mm256_fnmadd_pd(_mm256_set1_pd(b), c, a);
#else
  return a - b * c;
#endif
}

/// Moves every number to the next lane, 0 to the first.
inline Pack shifted(const Pack& x) {
  return [&x]<std::size_t... l>(std::index_sequence<l...>) {
    return __builtin_shufflevector(Pack{}, x, (l == 0 ? 0 : pack_width + static_cast<int>(l) - 1)...);
  }
  (std::make_index_sequence<pack_width>{});
}

/// 1/x where x > 0, else 0.
inline double inverse_or_zero(double x) { return x > 0 ? 1 / x : 0.0; }
inline Pack inverse_or_zero(const Pack& x) { return x > 0 ? 1 / x : Pack{}; }

}  // namespace quicksand
