#include "accel/core/overlap.hpp"

namespace beambench::accel {

bool surface_overlaps(const scenes::Scene& scene, scenes::PrimitiveId id, const Box& box,
                      double tolerance) {
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return sphere_overlaps(scene.spheres[primitive.index], box, tolerance);
    case scenes::PrimitiveKind::kCone:
      return cone_overlaps(scene.cones[primitive.index], box, tolerance);
    case scenes::PrimitiveKind::kPolygon:
      return polygon_overlaps(scene, scene.polygons[primitive.index], box, tolerance);
  }
  return true;
}

}  // namespace beambench::accel
