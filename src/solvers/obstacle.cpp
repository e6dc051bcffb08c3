#include "solvers/obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <vector>

#include "core/errors.hpp"
#include "solvers/conjugate_gradients.hpp"
#include "solvers/preconditioner.hpp"

namespace quicksand {

namespace {
double par(const char* n, double dflt) { const char* s = std::getenv(n); return s ? atof(s) : dflt; }

enum Membership : unsigned char { outside, inside, reached };

template <int Dim>
class ObstacleSolver {
 public:
  ObstacleSolver(const StencilMatrix<Dim, Cell>& matrix, const CellField& b, const CellField& volume, CellField& H,
                 const ObstacleOptions& options)
      : A_(matrix), layout_(matrix.layout), volume_(volume), H_(H), options_(options), b_(b) {}

  ObstacleReport solve() {
    prepare();
    if (report_.trivial) return report_;
    start_set();
    bool dbg = par("DBG", 0) > 0;
    const double eta = par("ETA", 3e-2);
    const int sweeps = (int)par("SWEEPS", 0);
    bool settled = false;
    for (report_.iterations = 1; report_.iterations <= options_.max_iterations; ++report_.iterations) {
      int cyc = report_.cycles;
      double alpha = correct(settled ? 0 : eta);
      int sw = (alpha > 0 && report_.iterations < 12) ? sweeps : 2;
      for (int k = 0; k < sw; ++k) smooth();
      A_.residual(b_, H_, r_, work_);
      report_.violation = violation();
      std::ptrdiff_t before = count_;
      std::ptrdiff_t changed = 0;
      if (report_.violation > tol_) changed = update_set();
      settled = changed == 0;
      if (dbg)
        printf("  outer %d cycles %d alpha %.3f set %td -> %td changed %td viol %.2e rebuilt %d\n", report_.iterations,
               report_.cycles - cyc, alpha, before, count_, changed, report_.violation, rebuilds_);
      if (report_.violation <= tol_) { report_.active = count_; return report_; }
    }
    throw NumericalError("obstacle not converged");
  }

 private:
  void prepare() {
    // a fraction within half the tolerance of the limit counts as at the limit
    tol_ = options_.tolerance / 2;
    for_each<Cell>(layout_, A_.box, [&](Cell c) {
      if (std::abs(b_[c]) <= tol_ * volume_[c]) b_[c] = 0;
      H_[c] = std::max(H_[c], 0.0);
    });
    report_.violation = maximum<Cell>(layout_, A_.box, 0, [&](Cell c) { return b_[c] / volume_[c]; });
    if (report_.violation > tol_) return;
    for_each<Cell>(layout_, A_.box, [&](Cell c) { H_[c] = 0; });
    report_.trivial = true;
  }
  void start_set() {
    const double room = par("ROOM", 1e-3);
    d_ = CellField(layout_);
    q_ = CellField(layout_);
    r_ = b_;
    set_ = CellMask(layout_, outside);
    reduced_ = StencilMatrix<Dim, Cell>(layout_, Stencil::star);
    for_each<Cell>(layout_, A_.box, [&](Cell c) { set_[c] = b_[c] > -room * volume_[c] || H_[c] > 0; });
    box_ = bounding_box<Cell>(layout_, A_.box, [&](Cell c) { return set_[c] != 0; });
    work_ = intersect(grow(box_, 1), A_.box);
    A_.residual(b_, H_, r_, work_);
    rebuild_ = true;
  }
  std::ptrdiff_t update_set() {
    front_.clear();
    std::ptrdiff_t changed = 0;
    const detail::Rows<Dim> rows(layout_, work_);
    count_ = 0;
    for (std::ptrdiff_t r = 0; r < rows.count; ++r)
      for (int i = 0; i < rows.length; ++i) {
        const Cell c{rows.start(r) + i};
        const bool in = H_[c] > 0 || r_[c] > tol_ * volume_[c];
        if (in != (set_[c] == inside)) ++changed;
        if (in && !(H_[c] > 0)) front_.push_back(c);
        set_[c] = in ? inside : outside;
        count_ += in;
      }
    if (par("TOPPLE", 1) > 0) changed += topple();
    box_ = bounding_box<Cell>(layout_, A_.box, [&](Cell c) { return set_[c] != 0; });
    work_ = intersect(grow(box_, 1), A_.box);
    stale_ += changed;
    if ((double)stale_ > par("STALE", 0.05) * (double)count_) rebuild_ = true;
    if (changed) refill_ = true;
    return changed;
  }
  std::ptrdiff_t topple() {
    std::ptrdiff_t added = 0;
    std::vector<Cell> wave = front_, next, met;
    for (Cell c : wave) q_[c] = r_[c];
    while (!wave.empty()) {
      met.clear();
      for (Cell c : wave) {
        int n = 0;
        for_neighbours(c, [&](Cell k) { n += set_[k] != inside; });
        for_neighbours(c, [&](Cell k) {
          if (set_[k] == inside) return;
          if (set_[k] == outside) set_[k] = reached, q_[k] = r_[k], met.push_back(k);
          q_[k] += q_[c] / n;
        });
      }
      next.clear();
      for (Cell k : met) {
        if (q_[k] > 0) set_[k] = inside, next.push_back(k);
        else set_[k] = outside, r_[k] = q_[k];
      }
      added += (std::ptrdiff_t)next.size();
      std::swap(wave, next);
    }
    count_ += added;
    return added;
  }
  template <class F> void for_neighbours(Cell c, F&& f) {
    for (std::size_t e = 0; e < A_.lower.size(); ++e) {
      if (A_.lower[e][c] != 0) f(c - A_.steps[e]);
      if (A_.lower[e][c + A_.steps[e]] != 0) f(c + A_.steps[e]);
    }
  }
  double violation() {
    return maximum<Cell>(layout_, work_, 0, [&](Cell c) {
      const double v = r_[c] / volume_[c];
      return H_[c] > 0 ? std::abs(v) : v;
    });
  }
  void reduce() {
    reduced_.box = box_;
    for_each<Cell>(layout_, box_, [&](Cell c) { reduced_.diagonal[c] = A_.diagonal[c]; });
    for (int d = 0; d < Dim; ++d) {
      const auto e = static_cast<std::size_t>(d);
      const Step s = layout_.step(d);
      for_each<Cell>(layout_, extend_high(box_, d), [&](Cell c) { reduced_.lower[e][c] = set_[c] && set_[c - s] ? A_.lower[e][c] : 0; });
    }
    refill_ = false;
  }
  double correct(double eta) {
    if (box_.empty()) return 0;
    if (refill_) reduce();
    if (rebuild_) {
      preconditioner_.emplace(reduced_);
      pre_box_ = box_;
      ++rebuilds_;
      rebuild_ = false;
      stale_ = 0;
    }
    for_each<Cell>(layout_, work_, [&](Cell c) { d_[c] = 0, q_[c] = set_[c] ? r_[c] : 0; });
    Tolerance t;
    t.relative = eta;
    t.absolute = 0.3 * tol_;
    t.max_iterations = 100;
    const auto rep = conjugate_gradients<Cell>(
        layout_, box_, [&](const CellField& x, CellField& y) { reduced_.apply(x, y); },
        [&](const CellField& x, CellField& y) {
          if (pre_box_ == box_ && stale_ == 0) return (*preconditioner_)(x, y);
          for_each<Cell>(layout_, box_, [&](Cell c) { y[c] = x[c] / A_.diagonal[c]; });
          (*preconditioner_)(x, y);
          for_each<Cell>(layout_, box_, [&](Cell c) { y[c] = set_[c] ? y[c] : 0; });
        },
        q_, d_, t, [&](const CellField& x) {
          return maximum<Cell>(layout_, box_, 0, [&](Cell c) { return std::abs(x[c]) / volume_[c]; });
        });
    report_.cycles += rep.iterations;
    for_each<Cell>(layout_, box_, [&](Cell c) { d_[c] = std::max(d_[c], -H_[c]); });
    A_.apply(d_, q_, work_);
    const double slope = dot<Cell>(layout_, box_, r_, d_);
    const double curvature = dot<Cell>(layout_, box_, d_, q_);
    if (!(slope > 0)) return -1;
    double alpha = slope / curvature;
    const double limit = 1 / maximum<Cell>(layout_, box_, 1e-300, [&](Cell c) { return d_[c] < 0 ? -d_[c] / H_[c] : 0; });
    alpha = std::min(alpha, std::max(1.0, limit));
    combine<Cell>(layout_, box_, H_, d_, [alpha](double& h, double d) { h += alpha * d; if (h < 0) h = 0; });
    return alpha;
  }
  void smooth() {
    for_each_coloured<Cell>(layout_, work_, [&](Cell c, const Index<Dim>&) {
      double s = b_[c];
      for (std::size_t e = 0; e < A_.lower.size(); ++e)
        s -= A_.lower[e][c] * H_[c - A_.steps[e]] + A_.lower[e][c + A_.steps[e]] * H_[c + A_.steps[e]];
      H_[c] = s > 0 ? s / A_.diagonal[c] : 0;
    });
  }

  const StencilMatrix<Dim, Cell>& A_;
  const Layout<Dim>& layout_;
  const CellField& volume_;
  CellField& H_;
  const ObstacleOptions& options_;
  CellField b_, r_, d_, q_;
  CellMask set_;
  Box<Dim> box_, work_, pre_box_;
  StencilMatrix<Dim, Cell> reduced_;
  std::optional<Preconditioner<Dim, Cell>> preconditioner_;
  ObstacleReport report_;
  double tol_ = 0;
  bool rebuild_ = true, refill_ = true;
  int rebuilds_ = 0;
  std::ptrdiff_t count_ = 0, stale_ = 0;
  std::vector<Cell> front_;
};

}  // namespace

template <int Dim>
ObstacleReport solve_obstacle(const StencilMatrix<Dim, Cell>& matrix, const CellField& b, const CellField& volume,
                              CellField& H, const ObstacleOptions& options) {
  return ObstacleSolver<Dim>(matrix, b, volume, H, options).solve();
}

template ObstacleReport solve_obstacle(const StencilMatrix<2, Cell>&, const CellField&, const CellField&, CellField&,
                                       const ObstacleOptions&);
template ObstacleReport solve_obstacle(const StencilMatrix<3, Cell>&, const CellField&, const CellField&, CellField&,
                                       const ObstacleOptions&);

}  // namespace quicksand
