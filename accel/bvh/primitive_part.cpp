#include "accel/bvh/primitive_part.hpp"

#include "accel/core/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"

namespace beambench::accel::bvh {

std::vector<PrimitivePart> collect_parts(const scenes::Scene& scene) {
  std::vector<PrimitivePart> parts;
  parts.reserve(scene.triangles.size() + scene.spheres.size() + scene.cones.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const scenes::Primitive& primitive = scene.primitives[id];
    if (primitive.kind != scenes::PrimitiveKind::kPolygon) {
      parts.push_back({id, primitive.index});
      continue;
    }
    const scenes::Polygon& polygon = scene.polygons[primitive.index];
    for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
      parts.push_back({id, polygon.first_triangle + i});
    }
  }
  return parts;
}

scenes::Bounds part_bounds(const scenes::Scene& scene, const PrimitivePart& part) {
  if (scene.primitives[part.primitive].kind != scenes::PrimitiveKind::kPolygon) {
    return scenes::primitive_bounds(scene, part.primitive);
  }
  scenes::Bounds bounds;
  for (const std::uint32_t vertex : scene.triangles[part.index].vertex) {
    bounds.include(scene.vertices[vertex]);
  }
  return bounds;
}

std::vector<scenes::Bounds> padded_boxes(const scenes::Scene& scene,
                                         std::span<const PrimitivePart> parts) {
  const double tolerance = overlap_tolerance(scene);
  std::vector<scenes::Bounds> boxes;
  boxes.reserve(parts.size());
  for (const PrimitivePart& part : parts) {
    boxes.push_back(padded(part_bounds(scene, part), tolerance));
  }
  return boxes;
}

}  // namespace beambench::accel::bvh
