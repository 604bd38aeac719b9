#pragma once
// The pieces that leaves refer to in a hierarchy over separate triangles of polygons.

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.hpp"

namespace beambench::accel::bvh {

/// A triangle of a polygon, or a whole sphere or cone. The nearest hit of a polygon's triangles is
/// the polygon's hit.
struct PrimitivePart {
  scenes::PrimitiveId primitive;
  std::uint32_t index;  ///< index into the scene's triangles, spheres or cones
};

/// Returns the parts of all primitives, in order of id.
std::vector<PrimitivePart> collect_parts(const scenes::Scene& scene);

/// Returns the box of a part without widening it.
scenes::Bounds part_bounds(const scenes::Scene& scene, const PrimitivePart& part);

/// Returns the boxes of parts, widened by `overlap_tolerance`.
std::vector<scenes::Bounds> padded_boxes(const scenes::Scene& scene,
                                         std::span<const PrimitivePart> parts);

}  // namespace beambench::accel::bvh
