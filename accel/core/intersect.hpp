#pragma once
// The canonical ray-primitive test for any primitive, and its use in a leaf.

#include <optional>
#include <span>

#include "accel/core/canonical_ray.hpp"
#include "accel/core/intersect_cone.hpp"
#include "accel/core/intersect_sphere.hpp"
#include "accel/core/intersect_triangle.hpp"
#include "accel/core/work_counters.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// Returns the nearest t in the ray's interval over the polygon's triangles, or kMiss.
inline float intersect_polygon(const CanonicalRay& ray, const scenes::Scene& scene,
                               const scenes::Polygon& polygon) {
  float nearest = kMiss;
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const auto& vertex = scene.triangles[polygon.first_triangle + i].vertex;
    const float t = intersect_triangle(ray, scene.vertices[vertex[0]], scene.vertices[vertex[1]],
                                       scene.vertices[vertex[2]]);
    if (is_hit(t) && !(nearest <= t)) nearest = t;
  }
  return nearest;
}

/// Returns the smallest t in the ray's interval at which it meets the primitive, or kMiss: the
/// definition that all classic structures share.
inline float intersect(const CanonicalRay& ray, const scenes::Scene& scene,
                       scenes::PrimitiveId id) {
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return intersect_sphere(ray, scene.spheres[primitive.index]);
    case scenes::PrimitiveKind::kCone:
      return intersect_cone(ray, scene.cones[primitive.index]);
    case scenes::PrimitiveKind::kPolygon:
      return intersect_polygon(ray, scene, scene.polygons[primitive.index]);
  }
  return kMiss;
}

/// The nearest hit so far: `ray.t_max` is its t, so that farther hits are not accepted.
struct ClosestHit {
  explicit ClosestHit(const Ray& query) : ray(query) {}

  /// Tests one primitive and keeps its hit if it precedes the best. Returns the test's t or kMiss.
  float test(const scenes::Scene& scene, scenes::PrimitiveId id) {
    const float t = intersect(ray, scene, id);
    keep(t, id);
    return t;
  }
  /// Keeps the result of a canonical test with `ray`, a t or kMiss, if it precedes the best.
  void keep(float t, scenes::PrimitiveId id) {
    if (t < ray.t_max || (t == ray.t_max && id < primitive)) {
      ray.t_max = t;
      primitive = id;
    }
  }
  std::optional<Hit> result() const {
    if (primitive == scenes::kNoPrimitive) return std::nullopt;
    return Hit{ray.t_max, primitive};
  }

  CanonicalRay ray;
  scenes::PrimitiveId primitive = scenes::kNoPrimitive;
};

}  // namespace beambench::accel
