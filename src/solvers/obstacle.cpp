#include "solvers/obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "solvers/conjugate_gradients.hpp"
#include "solvers/preconditioner.hpp"

namespace quicksand {

namespace {

/// Cells with room for less than this fraction start in the set: they fill up at once when volume passes through them.
constexpr double room_of_full_cells = 1e-3;
/// Reduction of the residual while the set changes. Looser values drop cells wrongly, tighter ones cost cycles.
constexpr double inexact = 1e-2;
/// Residual within the set, in terms of the tolerance: leaves some for what the projection adds.
constexpr double residual_share = 0.3;
/// After so many outer iterations every step is followed by Gauss-Seidel sweeps, which makes convergence certain.
constexpr int patience = 20;
/// Sums of a closed system below this fraction of their terms are round-off.
constexpr double round_off = 1e-13;
/// H that moves less than this volume fraction is 0. In full cells that nothing passes through it would otherwise
/// shrink from guess to guess, to numbers without digits that no later division stands.
constexpr double least_moved = 1e-16;

enum Membership : unsigned char { outside, inside, reached };

template <int Dim>
class ObstacleSolver {
 public:
  ObstacleSolver(const StencilMatrix<Dim, Cell>& matrix, const CellField& b, const CellField& volume, CellField& H,
                 const ObstacleOptions& options)
      : matrix_(matrix),
        layout_(matrix.layout),
        volume_(volume),
        potential_(H),
        max_iterations_(options.max_iterations),
        tolerance_(options.tolerance / 2),
        b_(b) {}

  ObstacleReport solve() {
    if (!check_and_clean()) return report_;
    balance();
    start();
    bool at_rest = false;
    while (report_.iterations < max_iterations_) {
      ++report_.iterations;
      const bool good = step_on_set(at_rest ? 0.0 : inexact);
      if (!good || report_.iterations > patience) {
        sweep();
        sweep();
        // They may have wetted the border, whose neighbours then take part.
        work_ = with_neighbours(work_);
      }
      matrix_.residual(b_, potential_, r_, work_);
      report_.violation = largest_violation();
      if (report_.violation <= tolerance_) {
        report_.active = count_positive();
        return report_;
      }
      at_rest = !update_set();
    }
    std::ostringstream message;
    message << "redistribution of volume: the obstacle problem did not converge in " << report_.iterations
            << " iterations (" << report_.cycles << " multigrid cycles); a volume fraction is still off by "
            << report_.violation;
    throw NumericalError(message.str());
  }

 private:
  template <class F>
  double total(F&& f) const {
    return sum<Cell>(layout_, matrix_.box, f);
  }

  /// h, or 0 where it is negative or moves nothing.
  double admissible(Cell c, double h) const { return h * matrix_.diagonal[c] > least_moved * volume_[c] ? h : 0.0; }

  /// Returns false when H = 0 solves the problem.
  bool check_and_clean() {
    if (!std::isfinite(total([&](Cell c) { return std::abs(b_[c]) + std::abs(potential_[c]); }))) {
      throw NumericalError("redistribution of volume: a volume fraction or H is not finite");
    }
    for_each<Cell>(layout_, matrix_.box, [&](Cell c) {
      if (std::abs(b_[c]) <= tolerance_ * volume_[c]) b_[c] = 0;
      potential_[c] = admissible(c, potential_[c]);
    });
    report_.violation = maximum<Cell>(layout_, matrix_.box, 0, [&](Cell c) { return b_[c] / volume_[c]; });
    report_.trivial = report_.violation <= tolerance_;
    if (report_.trivial) for_each<Cell>(layout_, matrix_.box, [&](Cell c) { potential_[c] = 0; });
    return !report_.trivial;
  }

  /// In a closed system nothing leaves: there must be room for the excess, and where the room is just enough the sum of
  /// the right-hand sides must vanish to round-off.
  void balance() {
    const double diagonal = total([&](Cell c) { return matrix_.diagonal[c]; });
    closed_ = total([&](Cell c) { return std::abs(matrix_.row_sum(c)); }) <= round_off * diagonal;
    if (!closed_) return;
    const double volume = total([&](Cell c) { return volume_[c]; });
    const double excess = total([&](Cell c) { return b_[c]; });
    if (excess > tolerance_ * volume) {
      std::ostringstream message;
      message << "redistribution of volume: the closed box is overfull, an excess volume of " << excess
              << " has no room (volume of the box " << volume << ")";
      throw NumericalError(message.str());
    }
    balanced_ = excess > -tolerance_ * volume;
    if (balanced_) {
      for_each<Cell>(layout_, matrix_.box, [&](Cell c) { b_[c] -= excess / volume * volume_[c]; });
    }
  }

  void start() {
    step_ = CellField(layout_);
    work_vector_ = CellField(layout_);
    r_ = b_;
    set_ = CellMask(layout_, outside);
    reduced_ = StencilMatrix<Dim, Cell>(layout_, Stencil::star);
    for_each<Cell>(layout_, matrix_.box, [&](Cell c) {
      set_[c] = b_[c] > -room_of_full_cells * volume_[c] || potential_[c] > 0 ? inside : outside;
    });
    bound_set(matrix_.box);
    matrix_.residual(b_, potential_, r_, work_);
  }

  /// Finds the boxes of the set, all of which lies in `where`.
  void bound_set(const Box<Dim>& where) {
    box_ = bounding_box<Cell>(layout_, where, [&](Cell c) { return set_[c] == inside; });
    work_ = with_neighbours(box_);
    set_is_new_ = true;
  }

  Box<Dim> with_neighbours(const Box<Dim>& cells) const {
    const Box<Dim> grown = grow(cells, 1);
    Box<Dim> inside = intersect(grown, matrix_.box);
    // What lies beyond one end of a periodic axis is at the other.
    if (!(inside == grown)) inside = close_rings(layout_, inside, matrix_.box);
    return inside;
  }

  std::ptrdiff_t count_positive() const {
    return static_cast<std::ptrdiff_t>(total([&](Cell c) { return potential_[c] > 0 ? 1.0 : 0.0; }));
  }

  double largest_violation() const {
    return maximum<Cell>(layout_, work_, 0, [&](Cell c) {
      const double error = r_[c] / volume_[c];
      return potential_[c] > 0 ? std::abs(error) : error;
    });
  }

  /// H += the projected solution of A d = r on the set. Returns false when the projection spoiled the direction.
  bool step_on_set(double reduction) {
    if (box_.empty()) return false;
    if (set_is_new_) set_up();
    for_each<Cell>(layout_, work_, [&](Cell c) {
      step_[c] = 0;
      work_vector_[c] = in_system(c) ? r_[c] : 0;
    });
    const Tolerance tolerance{reduction, residual_share * tolerance_, 100};
    const SolveReport linear = conjugate_gradients<Cell>(
        layout_, box_, [&](CellField& x, CellField& y) { reduced_.apply(x, y); }, *preconditioner_, work_vector_, step_,
        tolerance,
        [&](const CellField& x) {
          return maximum<Cell>(layout_, box_, 0, [&](Cell c) { return std::abs(x[c]) / volume_[c]; });
        });
    report_.cycles += linear.iterations;
    if (!linear.converged) use_next_method();
    if (pinned_ && balanced_) lift_step();
    return move_along_projected_step() && !(pinned_ && !balanced_);
  }

  void set_up() {
    pin_if_singular();
    reduced_.box = box_;
    for_each<Cell>(layout_, box_, [&](Cell c) { reduced_.diagonal[c] = matrix_.diagonal[c]; });
    for (int d = 0; d < Dim; ++d) {
      const CellField& all = matrix_.lower[static_cast<std::size_t>(d)];
      CellField& kept = reduced_.lower[static_cast<std::size_t>(d)];
      const Step along = layout_.step(d);
      for_each<Cell>(layout_, extend_high(box_, d), [&](Cell c, const Index<Dim>& i) {
        const Cell low = c + (layout_.image(d, i[d] - 1) - i[d]) * along;
        kept[c] = in_system(c) && in_system(low) ? all[c] : 0;
      });
    }
    reduced_.wrap_couplings();
    // A fresh hierarchy for every set: with one of an older set CG takes several times the iterations.
    preconditioner_.emplace(reduced_, method_);
    set_is_new_ = false;
  }

  bool in_system(Cell c) const { return set_[c] == inside && !(pinned_ && c == *pinned_); }

  /// The matrix of a closed system is singular on a set of all cells: H stays as it is in the cell with the most room.
  void pin_if_singular() {
    pinned_.reset();
    if (!closed_ || !(box_ == matrix_.box)) return;
    double least = std::numeric_limits<double>::max();
    const Rows<Dim> rows(layout_, box_);
    Cell emptiest;
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      for (int i = 0; i < rows.length; ++i) {
        const Cell c{rows.start(r) + i};
        if (set_[c] != inside) return;
        if (r_[c] / volume_[c] < least) {
          least = r_[c] / volume_[c];
          emptiest = c;
        }
      }
    }
    pinned_ = emptiest;
  }

  /// When the excess just fits, H is determined up to a constant: choose it such that its minimum is zero.
  void lift_step() {
    const double lift = maximum<Cell>(layout_, box_, std::numeric_limits<double>::lowest(),
                                      [&](Cell c) { return -(potential_[c] + step_[c]); });
    for_each<Cell>(layout_, box_, [&](Cell c) { step_[c] += lift; });
  }

  /// A preconditioner that fails once is not tried again.
  void use_next_method() {
    const Method used = preconditioner_->method();
    method_ = used == Method::smg ? Method::jacobi : Method::smg;
    set_is_new_ = true;
  }

  bool move_along_projected_step() {
    for_each<Cell>(layout_, box_, [&](Cell c) { step_[c] = std::max(step_[c], -potential_[c]); });
    matrix_.apply(step_, work_vector_, box_);
    const double slope = dot<Cell>(layout_, box_, r_, step_);
    const double curvature = dot<Cell>(layout_, box_, step_, work_vector_);
    if (!(slope > 0)) return false;
    // The functional falls by length (slope - length curvature / 2). Steps somewhat too long are left at 1 all the
    // same, because only a full step takes projected cells to zero and thereby out of the set.
    const double best = curvature > 0 ? slope / curvature : 1;
    const bool good = best > 0.5;
    double length = best;
    if (good && best < 1) length = 1;
    if (best > 1) {
      const double steepest_fall =
          maximum<Cell>(layout_, box_, 0, [&](Cell c) { return step_[c] < 0 ? -step_[c] / potential_[c] : 0.0; });
      length = steepest_fall > 0 ? std::clamp(1 / steepest_fall, 1.0, best) : best;
    }
    for_each<Cell>(layout_, box_,
                   [&, length](Cell c) { potential_[c] = admissible(c, potential_[c] + length * step_[c]); });
    return good;
  }

  /// One projected Gauss-Seidel sweep: the exact minimum in every cell in turn.
  void sweep() {
    wrap(layout_, matrix_.box, potential_);
    for_each_coloured<Cell>(layout_, work_, [&](Cell c, const Index<Dim>&) {
      double excess = b_[c];
      for (std::size_t e = 0; e < matrix_.lower.size(); ++e) {
        const Step s = matrix_.steps[e];
        excess -= matrix_.lower[e][c] * potential_[c - s] + matrix_.lower[e][c + s] * potential_[c + s];
      }
      potential_[c] = admissible(c, excess / matrix_.diagonal[c]);
    });
  }

  /// The set of cells with H > 0 or room for less than they get. Returns whether it changed.
  bool update_set() {
    std::vector<Cell> overfull;
    bool changed = false;
    const Rows<Dim> rows(layout_, work_);
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      for (int i = 0; i < rows.length; ++i) {
        const Cell c{rows.start(r) + i};
        const bool gets_too_much = !(potential_[c] > 0) && r_[c] > tolerance_ * volume_[c];
        const unsigned char now = potential_[c] > 0 || gets_too_much ? inside : outside;
        if (gets_too_much) overfull.push_back(c);
        changed = changed || now != set_[c];
        set_[c] = now;
      }
    }
    if (grow_ahead(std::move(overfull))) changed = true;
    if (changed) bound_set(matrix_.box);
    return changed;
  }

  /// Lets the excess of overfull cells run on, layer by layer, to neighbours outside the set; whoever it fills joins.
  /// Returns whether any cell joined.
  bool grow_ahead(std::vector<Cell> wave) {
    CellField& excess = work_vector_;
    bool joined = false;
    std::vector<Cell> met;
    for (const Cell c : wave) excess[c] = r_[c];
    while (!wave.empty()) {
      met.clear();
      for (const Cell c : wave) {
        int receivers = 0;
        for_each_neighbour(c, [&](Cell k) { receivers += set_[k] != inside ? 1 : 0; });
        for_each_neighbour(c, [&](Cell k) {
          if (set_[k] == inside) return;
          if (set_[k] == outside) {
            set_[k] = reached;
            excess[k] = r_[k];
            met.push_back(k);
          }
          excess[k] += excess[c] / receivers;
        });
      }
      wave.clear();
      for (const Cell k : met) {
        const bool full = excess[k] > 0;
        set_[k] = full ? inside : outside;
        if (full) wave.push_back(k);
        // What a cell took up counts when the next wave meets it. Residuals are computed afresh after the next step.
        if (!full) r_[k] = excess[k];
      }
      joined = joined || !wave.empty();
    }
    return joined;
  }

  template <class Body>
  void for_each_neighbour(Cell c, Body&& body) const {
    for (std::size_t e = 0; e < matrix_.lower.size(); ++e) {
      const Step s = matrix_.steps[e];
      if (matrix_.lower[e][c] != 0) body(layout_.image(c - s));
      if (matrix_.lower[e][c + s] != 0) body(layout_.image(c + s));
    }
  }

  const StencilMatrix<Dim, Cell>& matrix_;
  const Layout<Dim>& layout_;
  const CellField& volume_;
  CellField& potential_;  ///< H
  int max_iterations_;
  double tolerance_;
  CellField b_;
  CellField r_;  ///< b - A H on work_
  CellField step_, work_vector_;
  CellMask set_;
  Box<Dim> box_;   ///< of the set
  Box<Dim> work_;  ///< the set and its neighbours: H = 0 outside
  bool closed_ = false;
  bool balanced_ = false;  ///< closed, and the excess just fits
  std::optional<Cell> pinned_;
  bool set_is_new_ = true;
  StencilMatrix<Dim, Cell> reduced_;  ///< the matrix on the set; couplings out of it are left out
  Method method_ = Method::automatic;
  std::optional<Preconditioner<Dim, Cell>> preconditioner_;
  ObstacleReport report_;
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
