#include "accel/overlap.hpp"

namespace beambench {

bool surface_overlaps(const Scene& scene, PrimitiveId id, const Box& box, double tolerance) {
  const Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case PrimitiveKind::kSphere:
      return sphere_overlaps(scene.spheres[primitive.index], box, tolerance);
    case PrimitiveKind::kCone:
      return cone_overlaps(scene.cones[primitive.index], box, tolerance);
    case PrimitiveKind::kPolygon:
      return polygon_overlaps(scene, scene.polygons[primitive.index], box, tolerance);
  }
  return true;
}

}  // namespace beambench
