// Kernels of the time step on a box full of liquid but for a slanted surface near its top, and the machine's memory
// bandwidth (triad) to judge them by.
//
// The counter `bytes_per_cell` is what a kernel must move if every field it reads or writes crosses the memory bus
// once: divided by the time per cell it is compared with the triad's bandwidth.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "core/threads.hpp"
#include "core/vector_fields.hpp"
#include "physics/convection.hpp"
#include "physics/diffusion.hpp"
#include "physics/energy.hpp"
#include "physics/projection.hpp"
#include "physics/redistribution.hpp"
#include "physics/viscous_functional.hpp"
#include "solvers/multigrid.hpp"
#include "support/mixtures.hpp"

namespace quicksand {
namespace {

constexpr double dt = 1e-3;

/// A flow to run kernels on: n cells along every axis, a quarter as many along x in the plane.
template <int Dim>
struct Bed {
  Domain<Dim> domain;
  testing::Mixture<Dim> mixture;
  CellVectors<Dim> u, acceleration;
  CellVectors<Dim> u_half;
  FaceScalars<Dim> u_mac;

  Bed(const Grid<Dim>& grid, const Law& law)
      : domain(testing::make_domain(Grid<Dim>(grid), SideKind::no_slip)),
        mixture(domain, {testing::liquid_species(1, law)}),
        u(domain.layout()),
        acceleration(domain.layout()),
        u_half(domain.layout()),
        u_mac(domain.layout()) {
    testing::set_cells(domain.grid, mixture.phi[0], [&](const Vec<Dim>& x) {
      const double depth = (0.9 + 0.05 * x[0] - x[Dim - 1]) / domain.grid.smallest_width();
      return std::clamp(depth + 0.5, 0.0, 1.0);
    });
    mixture.update();
    for (int d = 0; d < Dim; ++d) {
      testing::set_cells(domain.grid, u[d], [&](const Vec<Dim>& x) { return std::sin(5 * x[d] + 7 * x[(d + 1) % Dim]); });
    }
    fill_velocity_ghosts(domain, u);
    predict_velocities(domain, input(), dt, u_half, u_mac);
  }
  ConvectionInput<Dim> input() const {
    return {mixture.phi, mixture.total, mixture.rho, u, acceleration, mixture.liquid, mixture.interfaces};
  }
};

template <int Dim>
Grid<Dim> grid_of(int n);
template <>
Grid<2> grid_of<2>(int n) {
  return {{testing::uniform_axis(n / 4, 0, 0.25), testing::uniform_axis(n)}, Geometry::axisymmetric};
}
template <>
Grid<3> grid_of<3>(int n) {
  return testing::box_grid(n);
}

/// Times body(); `fields` is the number of doubles per cell that have to be moved.
template <int Dim, class Body>
void measure(benchmark::State& state, const Grid<Dim>& grid, double fields, Body&& body) {
  body();  // the first touch of work arrays does not count
  for (auto _ : state) body();
  const auto cells = static_cast<double>(grid.cells().size());
  state.counters["cells"] = cells;
  state.counters["bytes_per_cell"] = 8 * fields;
  state.counters["dimension"] = Dim;
}

void triad(benchmark::State& state) {
  const auto cells = static_cast<int>(state.range(0));
  const Layout<2> layout(Index<2>{{1024, cells / 1024}});
  const Box<2> box{Index<2>{}, layout.cells()};
  CellField a(layout), b(layout, 1), c(layout, 2);
  for (auto _ : state) for_each<Cell>(layout, box, [&](Cell p) { a[p] = b[p] + 3 * c[p]; });
  state.counters["cells"] = cells;
  state.counters["bytes_per_cell"] = 32;  // a is read as well before it is written
  state.counters["dimension"] = 0;
}

template <int Dim>
void register_kernels(int n) {
  const auto add = [n](const std::string& name, auto&& kernel) {
    benchmark::RegisterBenchmark((name + "/" + std::to_string(Dim) + "d/" + std::to_string(n)).c_str(), kernel);
  };
  const auto with_bed = [n](double fields, const Law& law, auto&& make) {
    return [=](benchmark::State& state) {
      Bed<Dim> bed(grid_of<Dim>(n), law);
      auto body = make(bed);
      measure(state, bed.domain.grid, fields, body);
    };
  };
  const Law inviscid = Inviscid{};
  const Law newtonian = Newtonian{0.01};
  const Law slurry = Papanastasiou{0, 0.3, 200};
  constexpr double D = Dim;

  add("dot", with_bed(D * 2, inviscid, [](Bed<Dim>& bed) {
        return [&] {
          benchmark::DoNotOptimize(dot<Cell>(bed.domain.layout(), bed.domain.grid.cells(), bed.u, bed.acceleration));
        };
      }));
  add("kinetic energy", with_bed(D + 2, inviscid, [](Bed<Dim>& bed) {
        return [&] { benchmark::DoNotOptimize(kinetic_energy(bed.domain.grid, bed.mixture.rho, bed.u)); };
      }));
  add("predict", with_bed(2 + 7 * D, inviscid, [](Bed<Dim>& bed) {
        return [&] { predict_velocities(bed.domain, bed.input(), dt, bed.u_half, bed.u_mac); };
      }));
  add("convect", with_bed(4 + 10 * D, inviscid, [](Bed<Dim>& bed) {
        return [&, phi = bed.mixture.phi, m = bed.u, escaped = std::vector<double>(1)]() mutable {
          convect(bed.domain, bed.mixture.species, bed.input(), dt, bed.u_mac, bed.u_half, phi, m, escaped);
        };
      }));
  add("planes", with_bed(3 + D, inviscid, [](Bed<Dim>& bed) {
        return [&] { reconstruct_interfaces(bed.domain.grid, bed.mixture.phi, bed.mixture.interfaces); };
      }));
  add("levers", with_bed(2 + D, inviscid, [](Bed<Dim>& bed) {
        return [&] {
          find_pressure_elements(bed.domain, bed.mixture.species, bed.mixture.phi, bed.mixture.total, bed.mixture.interfaces,
                                 bed.mixture.elements);
        };
      }));
  add("pressure gradient", with_bed(2 + 2 * D, inviscid, [](Bed<Dim>& bed) {
        return [&, pressure = NodeField(bed.domain.layout())] {
          add_pressure_gradient(bed.domain, pressure, bed.mixture.rho, bed.mixture.elements, dt, bed.u);
        };
      }));
  const auto matrix_kernel = [](Stencil stencil, bool cycle) {
    return [=](Bed<Dim>& bed) {
      const Layout<Dim>& layout = bed.domain.layout();
      auto matrix = std::make_shared<StencilMatrix<Dim, Cell>>(layout, stencil);
      for_each<Cell>(layout, matrix->box, [&](Cell c) { matrix->diagonal[c] = 2.01 * double(matrix->lower.size()); });
      for (auto& lower : matrix->lower) for_each<Cell>(layout, matrix->box, [&](Cell c) { lower[c] = -1; });
      std::shared_ptr<Multigrid<Dim, Cell>> multigrid;
      if (cycle) multigrid = std::make_shared<Multigrid<Dim, Cell>>(*matrix, MultigridKind::pfmg);
      return [=, x = CellField(layout, 1), y = CellField(layout)]() mutable {
        cycle ? multigrid->cycle(x, y) : matrix->apply(x, y);
      };
    };
  };
  const double block = Dim == 2 ? 5 : 14;
  add("matrix, star", with_bed(D + 3, inviscid, matrix_kernel(Stencil::star, false)));
  add("matrix, block", with_bed(block + 2, inviscid, matrix_kernel(Stencil::box, false)));
  add("PFMG cycle", with_bed(4 * (D + 3), inviscid, matrix_kernel(Stencil::star, true)));

  const auto viscous = [](bool assemble) {
    return [=](Bed<Dim>& bed) {
      auto work = std::make_shared<DiffusionWork<Dim>>(bed.domain, bed.mixture.species);
      work->acquire(bed.domain.layout());
      mark_stress_elements(bed.domain, bed.mixture.species, bed.mixture.phi, bed.mixture.total, work->elements);
      work->matrix.set_box(bed.domain.grid.cells());
      return [&bed, work, assemble, g = bed.u]() mutable {
        if (assemble) return assemble_matrix(bed.domain, bed.u, dt, Linearisation::tangent, *work);
        evaluate_functional(bed.domain, bed.acceleration, bed.u, dt, *work, g);
      };
    };
  };
  for (const auto& [name, law] : {std::pair{"Newtonian", newtonian}, std::pair{"slurry", slurry}}) {
    const std::string of = std::string(", ") + name;
    add("stress" + of, with_bed(4 * D + 4, law, viscous(false)));
    add("viscous matrix" + of, with_bed(2 * D + 2 + block * D * D, law, viscous(true)));
  }
}

}  // namespace
}  // namespace quicksand

/// Arguments after those of Google Benchmark: threads, then pairs of dimension and cells along an axis.
int main(int argc, char** argv) {
  quicksand::start_with_patient_threads(argv);
  benchmark::Initialize(&argc, argv);
  if (argc < 2) return 1;
  quicksand::set_threads(std::atoi(argv[1]));
  benchmark::RegisterBenchmark("triad", quicksand::triad)->Arg(1 << 23)->Unit(benchmark::kMillisecond);
  for (int k = 2; k + 1 < argc; k += 2) {
    const int n = std::atoi(argv[k + 1]);
    std::atoi(argv[k]) == 2 ? quicksand::register_kernels<2>(n) : quicksand::register_kernels<3>(n);
  }
  benchmark::RunSpecifiedBenchmarks();
}
