// The only file that knows hypre.
// MPI's C interface is enough; its old C++ bindings would add a library.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <HYPRE_config.h>
#include <HYPRE_struct_ls.h>
#include <HYPRE_utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/threads.hpp"
#include "solvers/multigrid.hpp"

namespace quicksand {

namespace {

#if defined(HYPRE_SEQUENTIAL)
constexpr MPI_Comm self_communicator = 0;
#else
const MPI_Comm self_communicator = MPI_COMM_SELF;
#endif

/// MPI and hypre, started on first use and ended at exit. A program that brought up MPI itself also ends it.
class Session {
 public:
  static void ensure() { static const Session session; }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  Session() {
#if !defined(HYPRE_SEQUENTIAL)
    int running = 0;
    MPI_Initialized(&running);
    if (running == 0) {
      // Open MPI would start a daemon for this one process.
      ::setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
      MPI_Init(nullptr, nullptr);
      owns_mpi_ = true;
    }
#endif
#if HYPRE_RELEASE_NUMBER >= 22900
    HYPRE_Initialize();
#else
    HYPRE_Init();
#endif
  }
  ~Session() {
#if defined(HYPRE_SEQUENTIAL)
    HYPRE_Finalize();
#else
    int ended = 0;
    MPI_Finalized(&ended);
    if (ended != 0) return;
    HYPRE_Finalize();
    if (owns_mpi_) MPI_Finalize();
#endif
  }

  [[maybe_unused]] bool owns_mpi_ = false;
};

/// hypre's error flag is global and sticky: read and clear it.
void check_and_clear(const char* what) {
  const HYPRE_Int flag = HYPRE_GetError() & ~HYPRE_ERROR_CONV;
  HYPRE_ClearAllErrors();
  if (flag == 0) return;
  std::array<char, 1024> text{};
  HYPRE_DescribeError(flag, text.data());
  throw NumericalError(std::string("hypre, ") + what + ": " + text.data());
}

/// The axes of a box that hypre gets to see. Axes of one cell are left out, because they would only slow it down; two
/// axes are the least its solvers take.
template <int Dim>
struct SeenAxes {
  std::array<int, static_cast<std::size_t>(Dim)> axis{};
  std::size_t count = 0;

  explicit SeenAxes(const Box<Dim>& box) {
    std::array<bool, static_cast<std::size_t>(Dim)> seen{};
    std::size_t long_axes = 0;
    for (int d = 0; d < Dim; ++d) {
      if (box.extent(d) > 1) seen[static_cast<std::size_t>(d)] = true, ++long_axes;
    }
    for (std::size_t d = 0; d < seen.size() && long_axes < 2; ++d) {
      if (!seen[d]) seen[d] = true, ++long_axes;
    }
    for (int d = 0; d < Dim; ++d) {
      if (seen[static_cast<std::size_t>(d)]) axis[count++] = d;
    }
  }
};

/// Whether hypre's hierarchy can go round an axis of n points. It halves a period as long as that is even; PFMG then
/// relaxes what is left, for which 31 points are few enough, and SMG fails on more than one. Without the couplings
/// across the ends a cycle is still a preconditioner: some 55 iterations of CG on 96 x 96 points in place of 11.
bool takes_period(MultigridKind kind, int n) {
  int odd_part = n;
  while (odd_part % 2 == 0) odd_part /= 2;
  return n > 1 && odd_part <= (kind == MultigridKind::pfmg ? 31 : 1);
}

using HypreIndex = std::array<HYPRE_Int, 3>;

}  // namespace

bool pfmg_suits_27_points() { return HYPRE_RELEASE_NUMBER >= 30000; }

template <int Dim, class At>
struct Multigrid<Dim, At>::Hierarchy {
  Hierarchy(const StencilMatrix<Dim, At>& matrix, MultigridKind kind)
      : layout_(matrix.layout),
        box_(matrix.box),
        kind_(kind),
        axes_(box_),
        values_(static_cast<std::size_t>(box_.size())) {
    Session::ensure();
    HYPRE_ClearAllErrors();
    for (std::size_t d = 0; d < axes_.count; ++d) {
      const int n = box_.extent(axes_.axis[d]);
      high_[d] = n - 1;
      period_[d] = matrix.wraps(axes_.axis[d]) && takes_period(kind, n) ? n : 0;
    }
    try {
      create_grid();
      create_matrix(matrix);
      create_vectors();
      create_solver(matrix);
    } catch (...) {
      destroy();
      throw;
    }
  }
  Hierarchy(const Hierarchy&) = delete;
  Hierarchy& operator=(const Hierarchy&) = delete;
  ~Hierarchy() { destroy(); }

  void cycle(const Field<At>& r, Field<At>& z) {
    pack(r);
    HYPRE_StructVectorSetBoxValues(right_hand_side_, low_.data(), high_.data(), values_.data());
    if (kind_ == MultigridKind::pfmg) {
      HYPRE_StructPFMGSolve(solver_, operator_, right_hand_side_, solution_);
    } else {
      HYPRE_StructSMGSolve(solver_, operator_, right_hand_side_, solution_);
    }
    HYPRE_StructVectorGetBoxValues(solution_, low_.data(), high_.data(), values_.data());
    check_and_clear("multigrid cycle");
    unpack(z);
  }

 private:
  void create_grid() {
    HYPRE_StructGridCreate(self_communicator, static_cast<HYPRE_Int>(axes_.count), &grid_);
    HYPRE_StructGridSetExtents(grid_, low_.data(), high_.data());
    HYPRE_StructGridSetPeriodic(grid_, period_.data());
    HYPRE_StructGridAssemble(grid_);
    check_and_clear("grid_");
  }

  void create_matrix(const StencilMatrix<Dim, At>& matrix) {
    // Entry 0 is the diagonal, then the couplings within the axes_ seen; symmetric storage implies the upper ones.
    std::vector<HypreIndex> shape(1, HypreIndex{});
    std::vector<const Field<At>*> coefficient(1, &matrix.diagonal);
    for (std::size_t e = 0; e < matrix.offsets.size(); ++e) {
      HypreIndex offset{};
      int moves = 0;
      for (int d = 0; d < Dim; ++d) moves += matrix.offsets[e][d] != 0 ? 1 : 0;
      for (std::size_t d = 0; d < axes_.count; ++d) {
        offset[d] = matrix.offsets[e][axes_.axis[d]];
        moves -= offset[d] != 0 ? 1 : 0;
      }
      if (moves != 0) continue;
      shape.push_back(offset);
      coefficient.push_back(&matrix.lower[e]);
    }
    HYPRE_StructStencilCreate(static_cast<HYPRE_Int>(axes_.count), static_cast<HYPRE_Int>(shape.size()), &stencil_);
    for (std::size_t k = 0; k < shape.size(); ++k) {
      HYPRE_StructStencilSetElement(stencil_, static_cast<HYPRE_Int>(k), shape[k].data());
    }
    HYPRE_StructMatrixCreate(self_communicator, grid_, stencil_, &operator_);
    HYPRE_StructMatrixSetSymmetric(operator_, 1);
    HYPRE_StructMatrixInitialize(operator_);
    for (std::size_t k = 0; k < shape.size(); ++k) {
      pack(*coefficient[k]);
      drop_couplings_out_of_the_box(shape[k]);
      HYPRE_Int entry = static_cast<HYPRE_Int>(k);
      HYPRE_StructMatrixSetBoxValues(operator_, low_.data(), high_.data(), 1, &entry, values_.data());
    }
    HYPRE_StructMatrixAssemble(operator_);
    check_and_clear("matrix");
  }

  /// A coupling that leads out of the box_ must be zero, or the coarse matrices are wrong next to it; where hypre knows
  /// the axis as periodic it leads to the other end.
  void drop_couplings_out_of_the_box(const HypreIndex& offset) {
    std::ptrdiff_t inner = 1;  // points of a row, then of a plane, next to each other in values_
    for (std::size_t d = 0; d < axes_.count; ++d) {
      const int n = box_.extent(axes_.axis[d]);
      if (offset[d] != 0 && period_[d] == 0) {
        const std::ptrdiff_t layer = offset[d] < 0 ? 0 : n - 1;
        const std::ptrdiff_t size = box_.size();
        for (std::ptrdiff_t at = layer * inner; at < size; at += n * inner) {
          std::fill_n(values_.begin() + at, inner, 0.0);
        }
      }
      inner *= n;
    }
  }

  void create_vectors() {
    for (HYPRE_StructVector* vector : {&right_hand_side_, &solution_}) {
      HYPRE_StructVectorCreate(self_communicator, grid_, vector);
      HYPRE_StructVectorInitialize(*vector);
      HYPRE_StructVectorSetConstantValues(*vector, 0.0);
      HYPRE_StructVectorAssemble(*vector);
    }
    check_and_clear("vectors");
  }

  /// Tells PFMG the cells' widths as the matrix shows them, by which it chooses the axes to coarsen, and the weight of
  /// Jacobi's method where they differ much. It would make out the same, but for round-off, which depends on the number
  /// of threads: equal widths would be told apart by that.
  void set_widths(const StencilMatrix<Dim, At>& matrix) {
    constexpr double uncoupled = 1e100;
    constexpr double much = 0.1;  // square of the standard deviation over the mean
    std::array<HYPRE_Real, 3> width{1, 1, 1};
    double strongest = 0;
    bool differ = false;
    Field<At> coupling(layout_);  // of a point along an axis, both ways
    const double points = static_cast<double>(box_.size());
    for (std::size_t a = 0; a < axes_.count; ++a) {
      for_each<At>(layout_, box_, [&](At p, const Index<Dim>& i) {
        coupling[p] = 0;
        for (std::size_t e = 0; e < matrix.offsets.size(); ++e) {
          if (matrix.offsets[e][axes_.axis[a]] == 0) continue;
          if (stays(i + matrix.offsets[e])) coupling[p] -= matrix.lower[e][p];
          if (stays(i - matrix.offsets[e])) coupling[p] -= matrix.lower[e][p + matrix.steps[e]];
        }
      });
      const double mean = sum<At>(layout_, box_, [&](At p) { return coupling[p]; }) / points;
      const double square = sum<At>(layout_, box_, [&](At p) { return coupling[p] * coupling[p]; }) / points;
      differ = differ || square - mean * mean > much * mean * mean;
      width[a] = mean;
      strongest = std::max(strongest, mean);
    }
    for (std::size_t a = 0; a < axes_.count; ++a) {
      // Rounded, so that axes that are alike are taken in turn.
      width[a] = width[a] > 0 ? static_cast<float>(std::sqrt(strongest / width[a])) : uncoupled;
    }
    HYPRE_StructPFMGSetDxyz(solver_, width.data());
    if (differ) HYPRE_StructPFMGSetJacobiWeight(solver_, 2.0 / 3);
  }

  /// Whether a neighbour lies in the box, or across the ends of an axis that hypre knows as periodic.
  bool stays(const Index<Dim>& i) const {
    for (std::size_t d = 0; d < axes_.count; ++d) {
      const int axis = axes_.axis[d];
      if (period_[d] == 0 && (i[axis] < box_.lo[axis] || i[axis] >= box_.hi[axis])) return false;
    }
    return true;
  }

  void create_solver(const StencilMatrix<Dim, At>& matrix) {
    if (kind_ == MultigridKind::pfmg) {
      // Red-black relaxation keeps a star stencil_ on all levels; on box_ stencils hypre 2.26 writes beyond an array
      // with it, and round the odd number of points of a coarse level colours do not alternate.
      const HYPRE_Int relaxation = matrix.stencil == Stencil::star && period_ == HypreIndex{} ? 2 : 1;
      HYPRE_StructPFMGCreate(self_communicator, &solver_);
      HYPRE_StructPFMGSetMaxIter(solver_, 1);
      HYPRE_StructPFMGSetTol(solver_, 0.0);
      HYPRE_StructPFMGSetZeroGuess(solver_);
      HYPRE_StructPFMGSetRelaxType(solver_, relaxation);
      // Coarse matrices by Galerkin, as is the default: points without couplings then keep a zero exactly.
      HYPRE_StructPFMGSetNumPreRelax(solver_, 1);
      HYPRE_StructPFMGSetNumPostRelax(solver_, 1);
      HYPRE_StructPFMGSetLogging(solver_, 0);
      HYPRE_StructPFMGSetPrintLevel(solver_, 0);
      set_widths(matrix);
      // Setting up, PFMG writes the couplings of coarse star matrices from either end, with values alike to round-off:
      // on several threads that of the later one would stay, in cycles this does not occur.
      const ThreadScope one_thread(1);
      HYPRE_StructPFMGSetup(solver_, operator_, right_hand_side_, solution_);
      check_and_clear("set-up of PFMG");
    } else {
      HYPRE_StructSMGCreate(self_communicator, &solver_);
      HYPRE_StructSMGSetMemoryUse(solver_, 0);
      HYPRE_StructSMGSetMaxIter(solver_, 1);
      HYPRE_StructSMGSetTol(solver_, 0.0);
      HYPRE_StructSMGSetZeroGuess(solver_);
      HYPRE_StructSMGSetNumPreRelax(solver_, 1);
      HYPRE_StructSMGSetNumPostRelax(solver_, 1);
      HYPRE_StructSMGSetLogging(solver_, 0);
      HYPRE_StructSMGSetPrintLevel(solver_, 0);
      HYPRE_StructSMGSetup(solver_, operator_, right_hand_side_, solution_);
      check_and_clear("set-up of SMG");
    }
  }

  void destroy() {
    if (solver_ != nullptr) {
      kind_ == MultigridKind::pfmg ? HYPRE_StructPFMGDestroy(solver_) : HYPRE_StructSMGDestroy(solver_);
    }
    if (solution_ != nullptr) HYPRE_StructVectorDestroy(solution_);
    if (right_hand_side_ != nullptr) HYPRE_StructVectorDestroy(right_hand_side_);
    if (operator_ != nullptr) HYPRE_StructMatrixDestroy(operator_);
    if (stencil_ != nullptr) HYPRE_StructStencilDestroy(stencil_);
    if (grid_ != nullptr) HYPRE_StructGridDestroy(grid_);
    HYPRE_ClearAllErrors();
  }

  /// Copies rows between a field and the gapless array hypre takes: axes_ of one cell vanish by themselves.
  template <class FieldType, class Copy>
  void for_each_row(FieldType& field, Copy&& copy) {
    const Rows<Dim> rows(layout_, box_);
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      copy(&field[At{rows.start(r)}], values_.data() + r * rows.length, rows.length);
    }
  }
  void pack(const Field<At>& field) {
    for_each_row(field, [](const double* from, double* to, int n) { std::copy_n(from, n, to); });
  }
  void unpack(Field<At>& field) {
    for_each_row(field, [](double* to, const double* from, int n) { std::copy_n(from, n, to); });
  }

  Layout<Dim> layout_;
  Box<Dim> box_;
  MultigridKind kind_;
  SeenAxes<Dim> axes_;
  std::vector<double> values_;
  HypreIndex low_{};
  HypreIndex high_{};
  HypreIndex period_{};  ///< number of points along an axis that wraps, 0 along others
  HYPRE_StructGrid grid_ = nullptr;
  HYPRE_StructStencil stencil_ = nullptr;
  HYPRE_StructMatrix operator_ = nullptr;
  HYPRE_StructVector right_hand_side_ = nullptr;
  HYPRE_StructVector solution_ = nullptr;
  HYPRE_StructSolver solver_ = nullptr;
};

template <int Dim, class At>
Multigrid<Dim, At>::Multigrid(const StencilMatrix<Dim, At>& matrix, MultigridKind kind)
    : hierarchy_(std::make_unique<Hierarchy>(matrix, kind)) {}
template <int Dim, class At>
Multigrid<Dim, At>::~Multigrid() = default;
template <int Dim, class At>
Multigrid<Dim, At>::Multigrid(Multigrid&&) noexcept = default;
template <int Dim, class At>
Multigrid<Dim, At>& Multigrid<Dim, At>::operator=(Multigrid&&) noexcept = default;

template <int Dim, class At>
void Multigrid<Dim, At>::cycle(const Field<At>& r, Field<At>& z) {
  hierarchy_->cycle(r, z);
}

std::string hypre_version() { return HYPRE_RELEASE_VERSION; }

template class Multigrid<2, Cell>;
template class Multigrid<2, Node>;
template class Multigrid<3, Cell>;
template class Multigrid<3, Node>;

}  // namespace quicksand
