#include "app/case_codec.hpp"
#include "core/config_schema.hpp"
#include "core/config_variant.hpp"

namespace quicksand {

namespace dim = dimension;

Codec<Shape> shape_codec() {
  const auto number = quantity(dim::length);
  const auto size = quantity(dim::length, positive);
  const auto point = vector_of(dim::length);
  const auto corner = [number] {
    Codec<PolygonPoint> codec;
    codec.schema = detail::list_schema(number.schema, 2);
    codec.schema.add("maxItems", make_integer(2));
    codec.schema.add(schema_value, make_text("point [x, z], length in m"));
    codec.read = [number](Reading& reading, const ConfigNode& node, PolygonPoint& out) {
      if (node.kind != ConfigNode::Kind::list || node.children.size() != 2) {
        reading.problem(node, "must be a point [x, z]");
        return;
      }
      number.read(reading, node.children[0], out.x);
      number.read(reading, node.children[1], out.z);
    };
    codec.write = [](const PolygonPoint& p) { return make_list({make_number(p.x), make_number(p.z)}); };
    return codec;
  }();
  return keyed<Shape>({
      alternative<Shape, BoxShape>("box",
                                   {required("from", &BoxShape::from, point, {"lowest corner", "", {"[0, 0]"}}),
                                    required("to", &BoxShape::to, point, {"highest corner", "", {"[1 m, 0.5 m]"}})},
                                   "box along the axes"),
      alternative<Shape, LayerShape>(
          "layer",
          {required("bottom", &LayerShape::bottom, number, {"z of the lower surface", "", {"0"}}),
           required("top", &LayerShape::top, number, {"z of the upper surface", "", {"0.5 m"}})},
          "horizontal layer across the domain"),
      alternative<Shape, CylinderShape>(
          "cylinder",
          {required("center", &CylinderShape::center, point,
                    {"middle of the base; on the axis in axisymmetric cases", "", {"[0, 0]"}}),
           required("radius", &CylinderShape::radius, size, {"radius", "at least four cells", {"0.5 m"}}),
           required("height", &CylinderShape::height, size, {"height above the base", "", {"1 m"}})},
          "upright cylinder"),
      alternative<Shape, SphereShape>(
          "sphere",
          {required("center", &SphereShape::center, point,
                    {"middle; on the axis in axisymmetric cases", "", {"[0, 1 m]"}}),
           required("radius", &SphereShape::radius, size, {"radius", "at least four cells", {"0.5 m"}})},
          "sphere; a disc in planar cases"),
      alternative<Shape, HalfSpaceShape>(
          "half_space",
          {required("point", &HalfSpaceShape::point, point, {"a point of the plane", "", {"[0, 0.5 m]"}}),
           required("normal", &HalfSpaceShape::normal, vector_of(dim::none),
                    {"direction out of the filled half, of any length", "", {"[0, 1]"}})},
          "everything behind a plane"),
      alternative<Shape, PolygonShape>(
          "polygon",
          {required("points", &PolygonShape::points, list_of(corner, 3),
                    {"corners [x, z] in order; the last is joined to the first; a prism along y in 3-D",
                     "",
                     {"[[0, 0], [1 m, 0], [0, 0.5 m]]"}})},
          "polygon in the plane (x, z)"),
      alternative<Shape, WaveShape>(
          "wave",
          {maybe("bottom", &WaveShape::bottom, number, {"filled from this z up to the wave (or give top)", "", {"0"}}),
           maybe("top", &WaveShape::top, number, {"filled from the wave up to this z (or give bottom)", "", {"1 m"}}),
           required("level", &WaveShape::level, number, {"mean z of the wave", "", {"0.5 m"}}),
           required("amplitude", &WaveShape::amplitude, number,
                    {"height of the wave above its mean at x = 0",
                     "a few hundredths of its length for linear waves",
                     {"1 cm"}}),
           required("wavenumber", &WaveShape::wavenumber, quantity(dim::wavenumber, not_negative),
                    {"k of the shape cos(k x), or J0(k r) in axisymmetric cases",
                     "pi / width for one half wave",
                     {"3.14 1/m"}})},
          "layer bounded by a wave"),
  });
}

}  // namespace quicksand
