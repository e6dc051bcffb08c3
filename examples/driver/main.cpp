// A column of water, as wide as high, is set free and runs out over a dry floor. The flow is built in code, without a case
// file; the place of the front is printed as a table that plots as it is: dam_break > front.csv
#include <algorithm>
#include <cstdio>
#include <exception>
#include <vector>

#include <quicksand/app/shapes.hpp>
#include <quicksand/physics/diagnostics.hpp>
#include <quicksand/physics/flow.hpp>
#include <quicksand/physics/time_step.hpp>

namespace {

using namespace quicksand;

/// n cells from 0 to `length`, by their faces.
std::vector<double> even_faces(double length, int n) {
  std::vector<double> faces;
  for (int i = 0; i <= n; ++i) faces.push_back(length * i / n);
  return faces;
}

/// Lengths in widths of the column, times in sqrt(width / gravity).
Flow<2> column_of_water(int cells_per_width) {
  const Grid<2> grid({even_faces(4, 4 * cells_per_width), even_faces(1.5, 3 * cells_per_width / 2)}, Geometry::planar);

  Sides<2> sides;  // axis 0 is x, axis 1 is z; side 0 is the low one
  sides.at(0, 0).kind = SideKind::symmetry;
  sides.at(0, 1).kind = SideKind::free_slip;
  sides.at(1, 0).kind = SideKind::free_slip;
  sides.at(1, 1).kind = SideKind::open;

  FlowParameters<2> parameters;
  parameters.species = {Species{.name = "water", .density = 1, .law = Inviscid{}}};
  parameters.gravity = {0, -1};

  Flow<2> flow(Domain<2>(grid, sides), parameters);
  const Shape column = BoxShape{.from = {0, 0, 0}, .to = {1, 0, 1}};
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<2>& i) {
    flow.state().phi[0][c] = fraction(column, grid, i);
  });
  flow.initialize();
  return flow;
}

}  // namespace

int main() {
  try {
    Flow<2> flow = column_of_water(32);
    std::printf("time,front,height,energy\n");
    for (double next_output = 0; next_output <= 2; next_output += 0.25) {
      while (flow.state().time < next_output - 1e-12) {
        const double to_output = next_output - flow.state().time;
        flow.advance(std::min({stable_step(flow, 0.4), 0.02, to_output}));
      }
      const Diagnostics now = diagnose(flow);
      std::printf("%.4f,%.5f,%.5f,%.6f\n", flow.state().time, now.radius_base, now.height_axis,
                  now.kinetic_energy + now.potential_energy);
    }
  } catch (const std::exception& error) {  // NumericalError where a step fails: the flow is as before it
    std::fprintf(stderr, "dam_break: %s\n", error.what());
    return 1;
  }
}
