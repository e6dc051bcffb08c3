#include "solvers/preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include "core/errors.hpp"
#include "solvers/banded_cholesky.hpp"
#include "solvers/multigrid.hpp"

namespace quicksand {

namespace {

/// Systems for which size times bandwidth^2 is no more than this are factorised whatever their band.
constexpr double cheap_factors = 2e7;

/// Aspect ratio up to which relaxation by points suits a 9-point matrix.
constexpr double largest_point_aspect = 1.6;
/// Grading of two axes up to which PFMG is cheaper than SMG, whose plane relaxation costs far more in space.
template <int Dim>
constexpr double largest_pfmg_grading = Dim == 2 ? 3 : 30;

/// Shape of the cells as the matrix shows it: aspect ratios are square roots of ratios of couplings along two axes.
struct Anisotropy {
  double aspect = 1;  ///< largest aspect ratio
  double grading =
      1;  ///< how much the aspect ratio varies along each of two axes, the lesser of the two: 1 for any constant
          ///< aspect ratio and when one axis is graded, large where the strong direction turns round
};

/// The anisotropy of axes d and e.
template <int Dim, class At>
Anisotropy anisotropy(const StencilMatrix<Dim, At>& star, int d, int e) {
  const auto coupling = [&](int axis, At p) {
    const auto a = static_cast<std::size_t>(axis);
    return -std::min(star.lower[a][p], star.lower[a][p + star.steps[a]]);
  };
  // Largest squared ratio in every slice of the box across d, and across e. On a grid the ratio is a product f(x_d)
  // g(x_e), so that these are f and g up to a factor.
  std::vector<double> along_d(static_cast<std::size_t>(star.box.extent(d)));
  std::vector<double> along_e(static_cast<std::size_t>(star.box.extent(e)));
  Anisotropy result;
  const Rows<Dim> rows(star.layout, star.box);
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    Index<Dim> index = star.layout.multi(rows.start(r));
    for (int i = 0; i < rows.length; ++i, ++index[0]) {
      const At p{rows.start(r) + i};
      const double a = coupling(d, p);
      const double b = coupling(e, p);
      if (!(a > 0 && b > 0)) continue;
      double& slice_d = along_d[static_cast<std::size_t>(index[d] - star.box.lo[d])];
      double& slice_e = along_e[static_cast<std::size_t>(index[e] - star.box.lo[e])];
      slice_d = std::max(slice_d, a / b);
      slice_e = std::max(slice_e, a / b);
      result.aspect = std::max({result.aspect, a / b, b / a});
    }
  }
  const auto spread = [](const std::vector<double>& slices) {
    double high = 0;
    double low = std::numeric_limits<double>::max();
    for (const double s : slices) {
      if (s == 0) continue;  // no row couples both ways
      high = std::max(high, s);
      low = std::min(low, s);
    }
    return high > 0 ? std::sqrt(high / low) : 1.0;
  };
  result.aspect = std::sqrt(result.aspect);
  result.grading = std::min(spread(along_d), spread(along_e));
  return result;
}

template <int Dim, class At>
Anisotropy anisotropy(const StencilMatrix<Dim, At>& star) {
  Anisotropy worst;
  for (int d = 0; d < Dim; ++d) {
    for (int e = d + 1; e < Dim; ++e) {
      const Anisotropy pair = anisotropy(star, d, e);
      worst.aspect = std::max(worst.aspect, pair.aspect);
      worst.grading = std::max(worst.grading, pair.grading);
    }
  }
  return worst;
}

/// Banded Cholesky factors.
template <int Dim, class At>
class Factors {
 public:
  explicit Factors(const StencilMatrix<Dim, At>& matrix)
      : order_(matrix.layout, matrix.box), factors_(order_.size(), order_.bandwidth()) {
    order_.template for_each<At>([&](At p, const Index<Dim>& i, int n) {
      factors_.begin(n);
      factors_.add(n, n, matrix.diagonal[p]);
      const auto couple = [&](const Index<Dim>& j, const double& value) {
        const int neighbour = order_.number(j);
        if (neighbour >= 0 && neighbour != n && factors_.owner(n, neighbour) == n) factors_.add(n, neighbour, value);
      };
      for (std::size_t e = 0; e < matrix.lower.size(); ++e) {
        couple(i + matrix.offsets[e], matrix.lower[e][p]);
        couple(i - matrix.offsets[e], matrix.lower[e][p + matrix.steps[e]]);
      }
    });
    if (!factors_.factorize()) throw NumericalError("the Cholesky factorisation failed");
  }

  void operator()(const Field<At>& r, Field<At>& z) {
    packed_.resize(static_cast<std::size_t>(order_.size()));
    order_.template for_each<At>([&](At p, const Index<Dim>&, int n) { packed_[static_cast<std::size_t>(n)] = r[p]; });
    factors_.solve(packed_);
    order_.template for_each<At>([&](At p, const Index<Dim>&, int n) { z[p] = packed_[static_cast<std::size_t>(n)]; });
  }

 private:
  BandOrder<Dim> order_;
  BandedCholesky factors_;
  std::vector<double> packed_;
};

/// One multigrid cycle.
template <int Dim, class At>
class Cycle {
 public:
  Cycle(const StencilMatrix<Dim, At>& matrix, MultigridKind kind) : multigrid_(matrix, kind) {}
  void operator()(const Field<At>& r, Field<At>& z) { multigrid_.cycle(r, z); }

 private:
  Multigrid<Dim, At> multigrid_;
};

/// Division by the diagonal.
template <int Dim, class At>
class Diagonal {
 public:
  explicit Diagonal(const StencilMatrix<Dim, At>& matrix)
      : layout_(matrix.layout), box_(matrix.box), diagonal_(matrix.diagonal) {}

  void operator()(const Field<At>& r, Field<At>& z) const {
    for_each<At>(layout_, box_, [&](At p) { z[p] = r[p] / diagonal_[p]; });
  }

 private:
  Layout<Dim> layout_;
  Box<Dim> box_;
  Field<At> diagonal_;
};

}  // namespace

template <int Dim>
bool suits_factors(const Layout<Dim>& layout, const Box<Dim>& box) {
  const BandOrder<Dim> order(layout, box);
  return order.bandwidth() <= widest_scalar_band ||
         1.0 * order.size() * order.bandwidth() * order.bandwidth() <= cheap_factors;
}

std::string_view name(Method method) {
  switch (method) {
    case Method::automatic: return "automatic";
    case Method::direct: return "banded Cholesky";
    case Method::pfmg: return "CG with PFMG";
    case Method::star_pfmg: return "CG with PFMG of the star part";
    case Method::smg: return "CG with SMG";
    case Method::jacobi: return "CG with Jacobi";
  }
  return "unknown";
}

/// Iterations to 1e-8 behind this choice (uniform; aspect 20; both axes graded by 5; by 30): 5-point PFMG 9, 12, 23, 80
/// and SMG 5, 5, 5, 5 at about twice the cost of an iteration; 9-point PFMG 10, 79, 32, 100, PFMG of the star part 15,
/// 17, 23, 86 and SMG 5, 7, 5, 6; 27-point PFMG of the star part 27 (64 when graded by 30), SMG 5 (7) at ten times the
/// cost.
template <int Dim, class At>
Method choose_method(const StencilMatrix<Dim, At>& matrix) {
  if (suits_factors(matrix.layout, matrix.box)) return Method::direct;
  const bool star = matrix.stencil == Stencil::star;
  const Anisotropy shape = anisotropy(star ? matrix : star_part(matrix));
  if (shape.grading > largest_pfmg_grading<Dim>) return Method::smg;
  if (star) return Method::pfmg;
  const bool points_suit = Dim == 2 || pfmg_suits_27_points();
  return points_suit && shape.aspect <= largest_point_aspect ? Method::pfmg : Method::star_pfmg;
}

template <int Dim, class At>
struct Preconditioner<Dim, At>::Apply {
  std::variant<Factors<Dim, At>, Cycle<Dim, At>, Diagonal<Dim, At>> way;

  template <class Way, class... Arguments>
  explicit Apply(std::in_place_type_t<Way> type, Arguments&&... arguments)
      : way(type, std::forward<Arguments>(arguments)...) {}
};

template <int Dim, class At>
Preconditioner<Dim, At>::Preconditioner(const StencilMatrix<Dim, At>& matrix, Method method)
    : method_(method == Method::automatic ? choose_method(matrix) : method) {
  constexpr std::in_place_type_t<Factors<Dim, At>> factors;
  constexpr std::in_place_type_t<Cycle<Dim, At>> cycle;
  constexpr std::in_place_type_t<Diagonal<Dim, At>> diagonal;
  switch (method_) {
    case Method::automatic:
    case Method::direct: apply_ = std::make_unique<Apply>(factors, matrix); break;
    case Method::pfmg: apply_ = std::make_unique<Apply>(cycle, matrix, MultigridKind::pfmg); break;
    case Method::star_pfmg: apply_ = std::make_unique<Apply>(cycle, star_part(matrix), MultigridKind::pfmg); break;
    case Method::smg: apply_ = std::make_unique<Apply>(cycle, matrix, MultigridKind::smg); break;
    case Method::jacobi: apply_ = std::make_unique<Apply>(diagonal, matrix); break;
  }
}
template <int Dim, class At>
Preconditioner<Dim, At>::~Preconditioner() = default;
template <int Dim, class At>
Preconditioner<Dim, At>::Preconditioner(Preconditioner&&) noexcept = default;
template <int Dim, class At>
Preconditioner<Dim, At>& Preconditioner<Dim, At>::operator=(Preconditioner&&) noexcept = default;

template <int Dim, class At>
void Preconditioner<Dim, At>::operator()(const Field<At>& r, Field<At>& z) {
  std::visit([&](auto& way) { way(r, z); }, apply_->way);
}

template bool suits_factors(const Layout<2>&, const Box<2>&);
template bool suits_factors(const Layout<3>&, const Box<3>&);
template Method choose_method(const StencilMatrix<2, Cell>&);
template Method choose_method(const StencilMatrix<2, Node>&);
template Method choose_method(const StencilMatrix<3, Cell>&);
template Method choose_method(const StencilMatrix<3, Node>&);
template class Preconditioner<2, Cell>;
template class Preconditioner<2, Node>;
template class Preconditioner<3, Cell>;
template class Preconditioner<3, Node>;

}  // namespace quicksand
