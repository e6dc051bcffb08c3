// The explicit kernels on two grids that share a domain, in one process: every grid gets copies of its neighbour's
// cells as ghost cells, and must arrive at the same bits as one grid that owns all. What must hold before grids can be
// spread over processes.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "physics/convection.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

using testing::Mixture;

constexpr double dt = 0.002;

/// Copies from a grid of the whole domain to one that owns a part of it, ghost cells included.
template <int Dim>
class Copy {
 public:
  Copy(const Grid<Dim>& whole, const Grid<Dim>& part) : whole_(whole), part_(part) {}

  /// Number in the whole grid of a position of the part, which may be a ghost.
  std::ptrdiff_t there(const Index<Dim>& i) const {
    Index<Dim> global = i;
    for (int d = 0; d < Dim; ++d) global[d] += part_.owned_global().lo[d];
    return whole_.layout().flat(global);
  }
  template <class T>
  void operator()(const Field<Cell, T>& from, Field<Cell, T>& to) const {
    for_each<Cell>(part_.layout(), grow(part_.cells(), ghosts),
                   [&](Cell c, const Index<Dim>& i) { to[c] = from[Cell{there(i)}]; });
  }

 private:
  const Grid<Dim>& whole_;
  const Grid<Dim>& part_;
};

/// All that the explicit kernels read and write.
template <int Dim>
struct Step {
  Domain<Dim> domain;
  Mixture<Dim> mixture;
  CellVectors<Dim> u, acceleration, momentum;
  FaceScalars<Dim> u_mac;
  CellVectors<Dim> u_half;
  Fractions phi_tilde;
  std::vector<double> escaped;

  explicit Step(Domain<Dim> d)
      : domain(std::move(d)),
        mixture(domain, {testing::liquid_species(2), testing::liquid_species(1)}),
        u(domain.layout()),
        acceleration(domain.layout()),
        momentum(domain.layout()),
        u_mac(domain.layout()),
        u_half(domain.layout()),
        phi_tilde(mixture.phi),
        escaped(2, 0.0) {}
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  ConvectionInput<Dim> input() const {
    return {mixture.phi, mixture.total, mixture.rho, u, acceleration, mixture.liquid, mixture.interfaces};
  }
  void advance() {
    predict_velocities(domain, input(), dt, u_half, u_mac);
    convect(domain, mixture.species, input(), dt, u_mac, u_half, phi_tilde, momentum, escaped);
  }
};

/// Liquid of two species with a rough surface, at speeds that empty no cell within the step.
template <int Dim>
void set_up(Step<Dim>& step) {
  const Grid<Dim>& grid = step.domain.grid;
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    const double above = grid.centre(i)[Dim - 1] - 0.6;
    const double filled = std::clamp(0.5 - 6 * above + 0.6 * testing::rough(i, 2), 0.0, 1.0);
    const double total = filled < 0.2 ? 0.0 : filled;
    const double share = 0.5 + 0.5 * testing::rough(i, 3);
    step.mixture.phi[0][c] = share * total;
    step.mixture.phi[1][c] = (1 - share) * total;
  });
  step.mixture.update();
  step.u = testing::rough_vectors(grid, 4);
  step.acceleration = testing::rough_vectors(grid, 11);
  fill_velocity_ghosts(step.domain, step.u);
  fill_acceleration_ghosts(grid, step.domain.sides, step.acceleration);
}

template <int Dim>
void expect_halves_give_the_whole(const Grid<Dim>& grid, SideKind kind, int axis) {
  SCOPED_TRACE(axis);
  Step<Dim> whole(testing::make_domain(grid, kind));
  set_up(whole);
  whole.advance();
  const int middle = grid.owned_cells()[axis] / 2 + 1;
  std::vector<double> escaped(2, 0.0);
  for (int half = 0; half < 2; ++half) {
    Box<Dim> owned = grid.cells();
    (half == 0 ? owned.hi : owned.lo)[axis] = middle;
    std::array<std::vector<double>, Dim> faces;
    for (int d = 0; d < Dim; ++d) faces[static_cast<std::size_t>(d)] = grid.global_faces(d);
    Step<Dim> part(Domain<Dim>(Grid<Dim>(faces, grid.geometry(), owned), whole.domain.sides));
    const Copy<Dim> copy(grid, part.domain.grid);
    for (std::size_t s = 0; s < 2; ++s) copy(whole.mixture.phi[s], part.mixture.phi[s]);
    copy(whole.mixture.total, part.mixture.total);
    copy(whole.mixture.rho, part.mixture.rho);
    copy(whole.mixture.liquid, part.mixture.liquid);
    for (int d = 0; d < Dim; ++d) {
      copy(whole.u[d], part.u[d]);
      copy(whole.acceleration[d], part.acceleration[d]);
    }
    // Ghost cells beyond the domain follow from the owned ones by the same rules.
    part.mixture.update();
    part.advance();
    const Layout<Dim>& layout = part.domain.layout();
    for (int d = 0; d < Dim; ++d) {
      for_each<Face>(layout, part.domain.grid.faces(d), [&](Face f, const Index<Dim>& i) {
        const Face there{copy.there(i)};
        ASSERT_EQ(part.u_mac[d][f], whole.u_mac[d][there]);
      });
    }
    for_each<Cell>(layout, part.domain.grid.cells(), [&](Cell c, const Index<Dim>& i) {
      const Cell there{copy.there(i)};
      for (std::size_t s = 0; s < 2; ++s) ASSERT_EQ(part.phi_tilde[s][c], whole.phi_tilde[s][there]);
      for (int d = 0; d < Dim; ++d) ASSERT_EQ(part.momentum[d][c], whole.momentum[d][there]);
    });
    for (std::size_t s = 0; s < 2; ++s) escaped[s] += part.escaped[s];
  }
  for (std::size_t s = 0; s < 2; ++s) EXPECT_NEAR(escaped[s], whole.escaped[s], 1e-16);
}

TEST(PhysicsSeam, HalvesOfAPlaneGiveTheBitsOfTheWhole) {
  for (const int axis : {0, 1}) {
    expect_halves_give_the_whole(testing::stretched_grid(14), SideKind::no_slip, axis);
    expect_halves_give_the_whole(testing::stretched_grid(14), SideKind::open, axis);
    expect_halves_give_the_whole(testing::stretched_grid(14), SideKind::periodic, axis);
  }
}

TEST(PhysicsSeam, HalvesOfATankGiveTheBitsOfTheWhole) {
  for (const int axis : {0, 1}) expect_halves_give_the_whole(testing::tank_grid(14), SideKind::no_slip, axis);
}

TEST(PhysicsSeam, HalvesOfABoxGiveTheBitsOfTheWhole) {
  for (const int axis : {0, 1, 2}) {
    expect_halves_give_the_whole(testing::box_grid(8), SideKind::no_slip, axis);
    expect_halves_give_the_whole(testing::box_grid(8), SideKind::periodic, axis);
  }
}

}  // namespace
}  // namespace quicksand
