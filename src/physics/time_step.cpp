#include "physics/time_step.hpp"

#include <algorithm>
#include <cmath>

namespace quicksand {

template <int Dim>
double stable_step(const Flow<Dim>& flow, double cfl) {
  const Grid<Dim>& grid = flow.domain().grid;
  const State<Dim>& state = flow.state();
  double rate = 0;  // largest 1 / dt
  for (int d = 0; d < Dim; ++d) {
    const double g = std::abs(flow.parameters().gravity[d]);
    rate = std::max(rate, maximum<Cell>(grid.layout(), grid.cells(), 0.0, [&](Cell c) {
                      if (flow.total()[c] < empty_fraction) return 0.0;
                      const double v = std::abs(state.u[d][c]) / grid.width(d, c);
                      const double a = std::max(std::abs(state.acceleration[d][c]), g) / grid.width(d, c);
                      return (v + std::sqrt(v * v + 2 * a * cfl)) / (2 * cfl);
                    }));
  }
  return rate > 0 ? 1 / rate : INFINITY;
}

template double stable_step(const Flow<2>&, double);
template double stable_step(const Flow<3>&, double);

}  // namespace quicksand
