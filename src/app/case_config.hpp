#pragma once
/// \file
/// A case as its user describes it in YAML, complete with defaults and checked.
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "app/shapes.hpp"
#include "core/boundary.hpp"
#include "core/grid.hpp"
#include "core/units.hpp"
#include "physics/gas_regions.hpp"
#include "physics/solver_settings.hpp"
#include "physics/species.hpp"

namespace quicksand {

/// How cell widths change along a segment of an axis: all equal, or in geometric progression from the neighbour's
/// width.
enum class Stretch { uniform, smooth };

/// Part of an axis.
struct AxisSegment {
  std::optional<double> from;  ///< end of the segment before, where absent
  double to = 0;
  int cells = 0;
  Stretch stretch = Stretch::uniform;
};

struct GridConfig {
  int dimension = 2;
  Geometry geometry = Geometry::planar;  ///< planar in 3-D too; geometry_of() gives the grid's
  std::vector<AxisSegment> x;
  std::vector<AxisSegment> y;  ///< empty in two dimensions
  std::vector<AxisSegment> z;
};

/// The first part of a run, on a grid of its own: a grid sequence as in the report's Table 3.
struct StageConfig {
  double until = 0;  ///< time at which the flow moves on to the next stage's grid
  struct Axes {
    std::vector<AxisSegment> x, y, z;  ///< of the same domain as the case's grid
  } grid;
};

/// Grids made to follow the bubbles of the start while they grow, see FollowingGrid.
struct RegridConfig {
  int bubble_cells = 0;  ///< least number of cells on a bubble's radius
};

/// What comes in through a side.
struct Inflow {
  Vec<3> velocity;                  ///< the largest one of the profile
  std::optional<std::string> fill;  ///< species, gas where absent
  Profile profile = Profile::uniform;
};

/// A side of the domain; members that its kind does not have stay as they are.
struct SideConfig {
  SideKind kind = SideKind::free_slip;
  double pressure = 0;                   ///< outside an open side
  std::optional<std::string> outside{};  ///< species outside an open side, gas where absent
  Vec<3> velocity{};                     ///< of a no-slip wall
  Inflow inflow{};
};

/// The sides of the domain; those of y only in 3-D.
struct Boundaries {
  std::optional<SideConfig> x_min, x_max, y_min, y_max, z_min, z_max;
};

/// A shape filled with a species, moving with a uniform velocity.
struct InitialFill {
  std::string fill;  ///< name of the species
  Shape shape;
  Vec<3> velocity;
};

/// A bubble of adiabatic gas at the start: a ball, or a disc in planar cases, cut out of the liquid.
struct InitialBubble {
  Vec<3> center;
  double radius = 0;
  double pressure = 0;
  double adiabatic_exponent = 1.4;
};

/// An explosive charge, which starts as a bubble: see Charge, whose constants it has.
struct InitialCharge {
  Vec<3> center;
  double mass = 0;                     ///< of the whole charge, wherever planes of symmetry cut it
  double radius_constant = 0;          ///< J
  double minimum_radius_constant = 0;  ///< q
  double adiabatic_exponent = 1.4;
  std::optional<double> thickness;  ///< across the plane, in planar cases: M = mass / thickness
};

/// End of the run and size of its steps: either fixed, or by the CFL number with an upper limit.
struct TimeSettings {
  double end = 0;
  std::optional<double> step;
  std::optional<double> cfl;
  std::optional<double> max_step;  ///< present with cfl
  std::optional<double> min_step;  ///< may be present with cfl
  /// The run is over before its end when the flow is as steady as this, see SteadyState.
  std::optional<double> until_steady;
};

/// When something is written: at multiples of `every`, or at the given times (increasing); neither: start and end only.
struct OutputSchedule {
  std::optional<double> every;
  std::vector<double> times;
};

/// When checkpoints are written: whichever comes first, after a step. They do not change the steps.
struct CheckpointSettings {
  std::optional<double> every;  ///< in the flow's time; with it checkpoints outlast the run
  double wall_interval = 900;   ///< seconds on the wall
};

/// What is measured of the crater in a bed.
struct CraterSettings {
  std::vector<std::string> species;  ///< what the bed is made of
  std::optional<double> level;       ///< z of the undisturbed bed; the initial bed's median height where absent
  std::optional<double> every;       ///< interval; whenever fields are written where absent
};

struct OutputSettings {
  std::string directory = "results";
  OutputSchedule fields;
  CheckpointSettings checkpoint;
  bool history = true;
  std::optional<CraterSettings> crater;
};

struct CaseConfig {
  std::string title;
  UnitSystem units = UnitSystem::si;
  GridConfig grid;
  Boundaries boundaries;
  Vec<3> gravity;  ///< acceleration (x, y, z)
  double ambient_pressure = 0;
  std::vector<Species> species;
  std::vector<InitialFill> initial;
  std::vector<InitialBubble> bubbles;
  std::vector<InitialCharge> charges;
  TrappedGas trapped_gas;
  TimeSettings time;
  std::vector<StageConfig> stages;  ///< in order of time; what follows them runs on `grid`
  std::optional<RegridConfig> regrid;
  SolverSettings solver;
  GuardSettings guard;
  OutputSettings output;
};

/// Reads and checks a case file, with `KEY.PATH=VALUE` settings put over it.
/// \throws InputError naming every problem with file, line, column and key
CaseConfig read_case(const std::string& file, const std::vector<std::string>& settings = {});

/// As read_case(), from text; `source` names it in messages.
CaseConfig parse_case(const std::string& text, const std::string& source,
                      const std::vector<std::string>& settings = {});

/// The case as YAML with every default filled in; reads back to the same case.
std::string to_yaml(const CaseConfig& config);

/// JSON Schema (draft 2020-12) of case files.
std::string case_schema();

/// The grid's geometry (cartesian in 3-D).
Geometry geometry_of(const GridConfig& config);

/// Face coordinates of an axis made of segments.
/// \throws InputError where a smooth segment can't match its neighbour
std::vector<double> make_faces(const std::vector<AxisSegment>& segments);

/// Cells along each of a grid's axes: x, z, or x, y, z.
std::vector<long> axis_cells(const GridConfig& config);

/// Number of cells; a floating-point number because a wrong case may have any number of them.
double count_cells(const GridConfig& config);

/// The box of space that the grid fills; y is [0, 1] in two dimensions.
Extent domain_of(const GridConfig& config);

/// Number of the species with a name; as many as there are if there is none.
std::size_t species_number(const CaseConfig& config, const std::string& name);

/// The grid of a stage: that of the case with other axes.
GridConfig grid_of(const CaseConfig& config, const StageConfig& stage);

/// Grid of a case. \pre config.dimension == Dim
template <int Dim>
Grid<Dim> make_grid(const GridConfig& config);

/// Sides of a case's domain.
template <int Dim>
Sides<Dim> make_sides(const CaseConfig& config);

/// Vector (x, y, z) in the axes of a grid: (x, z) in two dimensions.
template <int Dim>
Vec<Dim> in_axes(const Vec<3>& v) {
  Vec<Dim> out;
  for (int d = 0; d < Dim; ++d) out[d] = v[d];
  out[Dim - 1] = v[2];
  return out;
}

}  // namespace quicksand
