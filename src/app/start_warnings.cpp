#include <algorithm>
#include <cmath>

#include "app/case_start.hpp"
#include "app/case_warnings.hpp"
#include "app/initial_bubbles.hpp"
#include "core/config_node.hpp"
#include "core/loop.hpp"

namespace quicksand {

namespace {

/// Cells between liquid and an open side below which a case is suspect.
constexpr int least_air_cells = 2;
/// Bubbles of a radius of fewer cells are not resolved.
constexpr int least_bubble_cells = 4;
/// Shapes of fewer cells across are not resolved.
constexpr double least_shape_cells = 2;

/// Component of vectors (x, y, z) along axis d of a grid.
template <int Dim>
int component(int d) {
  return d == Dim - 1 ? 2 : d;
}

template <int Dim>
std::string axis_name(int d) {
  return std::string(1, "xyz"[component<Dim>(d)]);
}

/// Number of the cell along axis d that a place lies in, or of the nearest.
template <int Dim>
int cell_at(const Grid<Dim>& grid, int d, double x) {
  int i = 0;
  while (i + 1 < grid.owned_cells()[d] && grid.face_position(d, i + 1) < x) ++i;
  return i;
}

/// Whether liquid begins within a few cells of a side.
template <int Dim>
bool liquid_near(const InitialState<Dim>& state, int d, int side) {
  Box<Dim> layer = state.grid.cells();
  if (side == 0) {
    layer.hi[d] = std::min(layer.hi[d], least_air_cells);
  } else {
    layer.lo[d] = std::max(layer.lo[d], layer.hi[d] - least_air_cells);
  }
  return maximum<Cell>(state.grid.layout(), layer, 0.0, [&](Cell c) { return state.liquid[c]; }) > 0;
}

template <int Dim>
void warn_of_open_sides(const CaseConfig& config, const InitialState<Dim>& state, CaseWarnings& found) {
  const Sides<Dim> sides = make_sides<Dim>(config);
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (!is_open(sides.at(d, s)) || sides.at(d, s).outside || !liquid_near(state, d, s)) continue;
      const std::string name = axis_name<Dim>(d) + (s == 0 ? "_min" : "_max");
      found.push_back({"boundaries." + name, "liquid begins less than " + std::to_string(least_air_cells) +
                                                 " cells from the open side " + name +
                                                 ": it may leave the grid; usual is air as high as the flow"});
    }
  }
}

template <int Dim>
void warn_of_bubbles(const CaseConfig& config, const Grid<Dim>& grid, CaseWarnings& found) {
  const std::vector<InitialBubble> bubbles = initial_bubbles(config);
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const Vec<Dim> center = in_axes<Dim>(bubbles[i].center);
    double widest = 0;
    for (int d = 0; d < Dim; ++d) widest = std::max(widest, grid.width_1d(d, cell_at(grid, d, center[d])));
    const double cells = bubbles[i].radius / widest;
    if (cells >= least_bubble_cells) continue;
    const std::size_t given = config.bubbles.size();
    const std::string path = i < given ? child_path("bubbles", i) : child_path("charges", i - given);
    found.push_back({path, std::string("the ") + (i < given ? "" : "minimum ") + "radius " + brief(bubbles[i].radius) +
                               " is " + brief(cells) + (cells < 1 ? " cells, less than one" : " cells") +
                               "; fewer than " + std::to_string(least_bubble_cells) +
                               " do not resolve it; usual are 8, as from regrid: {bubble_cells: 8}"});
  }
}

/// A shape against the cells along its thinnest axis.
template <int Dim>
void warn_of_thin_shape(const CaseConfig& config, std::size_t i, const Grid<Dim>& grid, CaseWarnings& found) {
  const Extent domain = domain_of(config.grid);
  const Extent extent = bounds(config.initial[i].shape, geometry_of(config.grid));
  for (int d = 0; d < Dim; ++d) {
    const int e = component<Dim>(d);
    const double low = std::max(extent.low[e], domain.low[e]);
    const double high = std::min(extent.high[e], domain.high[e]);
    // A shape that goes all the way is as thick as the domain, be it one cell.
    if (low <= domain.low[e] && high >= domain.high[e]) continue;
    const double width = grid.width_1d(d, cell_at(grid, d, (low + high) / 2));
    const double cells = (high - low) / width;
    if (cells >= least_shape_cells) continue;
    found.push_back({child_path("initial", i) + ".shape",
                     "is " + brief(cells) + " cells thick along " + axis_name<Dim>(d) + ", " + brief(high - low) +
                         " where cells are " + brief(width) + " wide: it is not resolved; usual are 8 or more"});
    return;
  }
}

/// Round shapes off a plane of symmetry that they cross.
void warn_of_mirrors(const CaseConfig& config, std::size_t i, CaseWarnings& found) {
  const InitialFill& fill = config.initial[i];
  const auto* sphere = std::get_if<SphereShape>(&fill.shape);
  const auto* cylinder = std::get_if<CylinderShape>(&fill.shape);
  if (sphere == nullptr && cylinder == nullptr) return;
  const Vec<3>& center = sphere != nullptr ? sphere->center : cylinder->center;
  const Extent extent = bounds(fill.shape, geometry_of(config.grid));
  const Extent domain = domain_of(config.grid);
  const Boundaries& b = config.boundaries;
  const std::optional<SideConfig> sides[3][2] = {{b.x_min, b.x_max}, {b.y_min, b.y_max}, {b.z_min, b.z_max}};
  for (int d = 0; d < (sphere != nullptr ? 3 : 2); ++d) {
    for (int s = 0; s < 2; ++s) {
      if (!sides[d][s] || sides[d][s]->kind != SideKind::symmetry) continue;
      const double plane = s == 0 ? domain.low[d] : domain.high[d];
      const bool crosses = extent.low[d] < plane && extent.high[d] > plane;
      const double off = std::abs(center[d] - plane);
      if (!crosses || off <= 1e-9 * (domain.high[d] - domain.low[d])) continue;
      const char axis = "xyz"[d];
      found.push_back({child_path("initial", i) + ".shape",
                       std::string("crosses the plane of symmetry ") + axis + " = " + brief(plane) +
                           " with its middle " + brief(off) +
                           " off it: shape and mirror image make no round body; usual is the middle on the plane"});
    }
  }
}

template <int Dim>
void warn_of(const CaseConfig& config, CaseWarnings& found) {
  const InitialState<Dim> state = fill_cells<Dim>(config);
  for (std::size_t i = 0; i < config.initial.size(); ++i) {
    if (!(state.volumes[i] > 0)) {
      found.push_back({child_path("initial", i) + ".shape", "the shape fills nothing of the grid"});
      continue;
    }
    warn_of_thin_shape(config, i, state.grid, found);
    warn_of_mirrors(config, i, found);
  }
  warn_of_bubbles(config, state.grid, found);
  warn_of_open_sides(config, state, found);
}

}  // namespace

void warn_of_start(const CaseConfig& config, CaseWarnings& found) {
  config.grid.dimension == 3 ? warn_of<3>(config, found) : warn_of<2>(config, found);
}

}  // namespace quicksand
