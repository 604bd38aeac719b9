#pragma once
// What the leaves of a hierarchy refer to where the triangles of a polygon are separate.

#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"

namespace beambench::accel::bvh {

/// A triangle of a polygon, or a whole sphere or cone. The nearest hit of a polygon's triangles is
/// the polygon's hit.
struct PrimitivePart {
  scenes::PrimitiveId primitive;
  std::uint32_t index;  ///< into the scene's triangles, spheres or cones
};

/// The parts of all primitives, in increasing id.
std::vector<PrimitivePart> collect_parts(const scenes::Scene& scene);

/// The box of a part, not widened.
scenes::Bounds part_bounds(const scenes::Scene& scene, const PrimitivePart& part);

}  // namespace beambench::accel::bvh
