#include "app/case_codec.hpp"

namespace quicksand {

namespace {

namespace dim = dimension;

Codec<std::vector<AxisSegment>> axis_codec() {
  const auto stretch = choice<Stretch>({{"uniform", Stretch::uniform}, {"smooth", Stretch::smooth}});
  return named(
      "axis",
      one_or_list_of(object<AxisSegment>({
          maybe(
              "from", &AxisSegment::from, quantity(dim::length),
              {"where the segment begins; required in the first, in others the end of the segment before", "0", {"0"}}),
          required("to", &AxisSegment::to, quantity(dim::length),
                   {"where the segment ends", "walls and open sides a few sizes of the flow away", {"2 m"}}),
          required("cells", &AxisSegment::cells, whole_number(1, 1000000),
                   {"number of cells of the segment",
                    "32 to 256 across the flow; twice as many cost 8 times (2-D) or 16 times (3-D) as much",
                    {"64"}}),
          defaulted("stretch", &AxisSegment::stretch, stretch,
                    "uniform: equal widths; smooth: geometric progression from the width of the neighbouring segment's "
                    "cells"),
      })));
}

}  // namespace

Codec<GridConfig> grid_codec() {
  const auto geometry = choice<Geometry>({{"planar", Geometry::planar}, {"axisymmetric", Geometry::axisymmetric}});
  const auto axis = axis_codec();
  return object<GridConfig>({
      required("dimension", &GridConfig::dimension, whole_number(2, 3), "2 for (x, z), 3 for (x, y, z)"),
      defaulted("geometry", &GridConfig::geometry, geometry, "planar, or axisymmetric (2-D only): x is the radius"),
      required("x", &GridConfig::x, axis, "horizontal or radial axis: one segment or a list of them"),
      maybe("y", &GridConfig::y, axis, "second horizontal axis, in 3-D only"),
      required("z", &GridConfig::z, axis, "vertical axis, upwards"),
  });
}

Codec<StageConfig> stage_codec() {
  const auto axis = axis_codec();
  const auto axes = object<StageConfig::Axes>({
      required("x", &StageConfig::Axes::x, axis, "horizontal or radial axis, with the ends of grid.x"),
      maybe("y", &StageConfig::Axes::y, axis, "second horizontal axis, in 3-D only, with the ends of grid.y"),
      required("z", &StageConfig::Axes::z, axis, "vertical axis, with the ends of grid.z"),
  });
  return object<StageConfig>({
      required("until", &StageConfig::until, quantity(dim::time, positive),
               {"when the flow moves on to the next stage's grid", "", {"15 ms"}}),
      required("grid", &StageConfig::grid, axes, "the axes of this stage"),
  });
}

Codec<RegridConfig> regrid_codec() {
  return object<RegridConfig>({
      required("bubble_cells", &RegridConfig::bubble_cells, whole_number(4, 1000),
               {"least number of cells on the radius of the smallest bubble while bubbles grow from their first size",
                "8",
                {"8"}}),
  });
}

}  // namespace quicksand
