#include "app/grid_sequence.hpp"

#include <algorithm>
#include <limits>

#include "app/adapted_axis.hpp"
#include "app/initial_bubbles.hpp"

namespace quicksand {

namespace {

/// The block of fine cells reaches so many radii beyond the bubbles ...
constexpr double room = 2.5;
/// ... and is given up when fewer are left: a bubble so grows threefold on one grid.
constexpr double least_room = 0.5;
/// Ratio of neighbouring widths outside the block, less one.
constexpr double growth = 0.15;
/// Stages begin at the first step that comes so close to their time.
constexpr double time_slack = 1e-12;

template <int Dim>
void extend(Region<Dim>& region, const Region<Dim>& other) {
  for (int d = 0; d < Dim; ++d) {
    region.low[d] = std::min(region.low[d], other.low[d]);
    region.high[d] = std::max(region.high[d], other.high[d]);
  }
}

template <int Dim>
Region<Dim> around(const std::vector<Region<Dim>>& regions) {
  Region<Dim> all = regions.front();
  for (const Region<Dim>& region : regions) extend(all, region);
  return all;
}

/// Number of bubbles at the start.
std::size_t count_bubbles(const CaseConfig& config) { return config.bubbles.size() + config.charges.size(); }

/// Where the bubbles of the start are by the case.
template <int Dim>
std::vector<Region<Dim>> initial_regions(const CaseConfig& config) {
  const Extent domain = domain_of(config.grid);
  const Vec<Dim> domain_low = in_axes<Dim>(domain.low);
  const Vec<Dim> domain_high = in_axes<Dim>(domain.high);
  std::vector<Region<Dim>> regions;
  for (const InitialBubble& bubble : initial_bubbles(config)) {
    const Vec<Dim> center = in_axes<Dim>(bubble.center);
    Region<Dim> region;
    for (int d = 0; d < Dim; ++d) {
      region.low[d] = std::max(center[d] - bubble.radius, domain_low[d]);
      region.high[d] = std::min(center[d] + bubble.radius, domain_high[d]);
    }
    regions.push_back(region);
  }
  return regions;
}

/// Where the first `count` bubbles of a flow are now, those that are left.
template <int Dim>
std::vector<Region<Dim>> present_regions(const Flow<Dim>& flow, std::size_t count) {
  const Grid<Dim>& grid = flow.domain().grid;
  const GasState& gas = flow.state().gas;
  std::vector<Region<Dim>> regions;
  for (const Bubble& b : gas.bubbles) {
    if (b.id > open_air + static_cast<int>(count)) continue;
    std::optional<Region<Dim>> region;
    const Rows<Dim> rows(grid.layout(), grid.cells());
    for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
      Index<Dim> i = grid.layout().multi(rows.start(r));
      for (; i[0] < rows.length; ++i[0]) {
        if (gas.region[grid.cell(i)] != b.id) continue;
        Region<Dim> cell;
        for (int d = 0; d < Dim; ++d) {
          cell.low[d] = grid.face_position(d, i[d]);
          cell.high[d] = grid.face_position(d, i[d] + 1);
        }
        if (!region) region = cell;
        extend(*region, cell);
      }
    }
    if (region) regions.push_back(*region);
  }
  return regions;
}

/// Width of the widest cell of an axis that meets an interval.
double widest(const std::vector<double>& faces, double low, double high) {
  double width = 0;
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    if (faces[i] < high && faces[i + 1] > low) width = std::max(width, faces[i + 1] - faces[i]);
  }
  return width;
}

}  // namespace

double first_grid_cells(const CaseConfig& config) {
  if (!config.regrid || count_bubbles(config) == 0) return 0;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0;
  const Extent domain = domain_of(config.grid);
  Extent around{domain.high, domain.low};
  for (const InitialBubble& bubble : initial_bubbles(config)) {
    smallest = std::min(smallest, bubble.radius);
    largest = std::max(largest, bubble.radius);
    for (int d = 0; d < 3; ++d) {
      around.low[d] = std::min(around.low[d], bubble.center[d] - bubble.radius);
      around.high[d] = std::max(around.high[d], bubble.center[d] + bubble.radius);
    }
  }
  const std::vector<long> given = axis_cells(config.grid);
  double cells = 1;
  for (std::size_t a = 0; a < given.size(); ++a) {
    const int d = a + 1 == given.size() ? 2 : static_cast<int>(a);
    const double block = std::min(domain.high[d], around.high[d] + room * largest) -
                         std::max(domain.low[d], around.low[d] - room * largest);
    cells *= static_cast<double>(given[a]) + std::max(0.0, block) * config.regrid->bubble_cells / smallest;
  }
  return cells;
}

template <int Dim>
GridSequence<Dim>::GridSequence(const CaseConfig& config)
    : config_(config), sides_(make_sides<Dim>(config)), following_(config.regrid && count_bubbles(config) > 0) {}

template <int Dim>
GridConfig GridSequence<Dim>::base() const {
  return stage_ < config_.stages.size() ? grid_of(config_, config_.stages[stage_]) : config_.grid;
}

template <int Dim>
double GridSequence<Dim>::radius(const Region<Dim>& bubble) const {
  const Extent domain = domain_of(config_.grid);
  const Region<Dim> whole{in_axes<Dim>(domain.low), in_axes<Dim>(domain.high)};
  const auto mirrored = [&](int d, int s) {
    const SideKind kind = sides_.at(d, s).kind;
    return kind == SideKind::axis || kind == SideKind::symmetry;
  };
  double largest = 0;
  for (int d = 0; d < Dim; ++d) {
    const double extent = bubble.high[d] - bubble.low[d];
    const bool cut =
        (bubble.low[d] <= whole.low[d] && mirrored(d, 0)) || (bubble.high[d] >= whole.high[d] && mirrored(d, 1));
    largest = std::max(largest, cut ? extent : extent / 2);
  }
  return largest;
}

template <int Dim>
bool GridSequence<Dim>::outgrown(const std::vector<Region<Dim>>& bubbles) const {
  const Region<Dim> all = around(bubbles);
  for (int d = 0; d < Dim; ++d) {
    const double least = least_room * block_radius_;
    if (all.low[d] < block_.low[d] + least || all.high[d] > block_.high[d] - least) return true;
  }
  return false;
}

template <int Dim>
Domain<Dim> GridSequence<Dim>::make(const std::vector<Region<Dim>>& bubbles) {
  ++number_;
  Grid<Dim> grid = make_grid<Dim>(base());
  if (!following_) return {grid, sides_};
  double smallest = std::numeric_limits<double>::infinity();
  block_radius_ = 0;
  for (const Region<Dim>& bubble : bubbles) {
    smallest = std::min(smallest, radius(bubble));
    block_radius_ = std::max(block_radius_, radius(bubble));
  }
  const double width = smallest / config_.regrid->bubble_cells;
  const Region<Dim> all = around(bubbles);
  following_ = false;
  std::array<std::vector<double>, Dim> faces;
  for (int d = 0; d < Dim; ++d) {
    const std::vector<double>& given = grid.global_faces(d);
    block_.low[d] = all.low[d] - room * block_radius_;
    block_.high[d] = all.high[d] + room * block_radius_;
    if (widest(given, all.low[d], all.high[d]) > width) following_ = true;
    faces[static_cast<std::size_t>(d)] = adapted_faces(given, {block_.low[d], block_.high[d], width, growth});
    // At a side of the domain there is nothing that a bubble could outgrow.
    if (block_.low[d] <= given.front()) block_.low[d] = -std::numeric_limits<double>::infinity();
    if (block_.high[d] >= given.back()) block_.high[d] = std::numeric_limits<double>::infinity();
  }
  if (following_) grid = Grid<Dim>(std::move(faces), grid.geometry());
  return {grid, sides_};
}

template <int Dim>
Domain<Dim> GridSequence<Dim>::first() {
  return make(initial_regions<Dim>(config_));
}

template <int Dim>
std::optional<Domain<Dim>> GridSequence<Dim>::next(const Flow<Dim>& flow) {
  bool changed = false;
  while (stage_ < config_.stages.size() && flow.state().time >= config_.stages[stage_].until * (1 - time_slack)) {
    ++stage_;
    changed = true;
  }
  if (!following_) return changed ? std::optional(make({})) : std::nullopt;
  const std::vector<Region<Dim>> bubbles = present_regions(flow, count_bubbles(config_));
  if (bubbles.empty()) following_ = false;
  if (!changed && following_ && !outgrown(bubbles)) return std::nullopt;
  return make(bubbles);
}

template <int Dim>
void GridSequence<Dim>::exchange(Archive& archive) {
  carry(archive, "grids/stage", stage_);
  carry(archive, "grids/number", number_);
  carry(archive, "grids/following", following_);
  carry(archive, "grids/block_radius", block_radius_);
  for (int d = 0; d < Dim; ++d) {
    carry(archive, "grids/block/" + std::to_string(d) + "/low", block_.low[d]);
    carry(archive, "grids/block/" + std::to_string(d) + "/high", block_.high[d]);
  }
}

template class GridSequence<2>;
template class GridSequence<3>;

}  // namespace quicksand
