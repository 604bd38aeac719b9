#include "harness/plugin/scene_arrays.hpp"

#include <cstddef>

namespace beambench::plugin {
namespace {

static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
static_assert(sizeof(scenes::Triangle) == sizeof(beambench_triangle) &&
              offsetof(scenes::Triangle, primitive) == offsetof(beambench_triangle, primitive));

}  // namespace

SceneArrays::SceneArrays(const scenes::Scene& scene) {
  spheres_.resize(scene.spheres.size());
  cones_.resize(scene.cones.size());
  const bool all_polygons = scene.spheres.empty() && scene.cones.empty();
  for (scenes::PrimitiveId id = 0; !all_polygons && id < scene.primitives.size(); ++id) {
    const scenes::Primitive& primitive = scene.primitives[id];
    if (primitive.kind == scenes::PrimitiveKind::kSphere) {
      const scenes::Sphere& s = scene.spheres[primitive.index];
      spheres_[primitive.index] = {
          {s.center.x, s.center.y, s.center.z}, s.radius, s.inside_only ? 1U : 0U, id};
    } else if (primitive.kind == scenes::PrimitiveKind::kCone) {
      const scenes::Cone& c = scene.cones[primitive.index];
      cones_[primitive.index] = {{c.base.x, c.base.y, c.base.z}, c.base_radius,
                                 {c.apex.x, c.apex.y, c.apex.z}, c.apex_radius,
                                 c.inside_only ? 1U : 0U,        id};
    }
  }
  view_ = {.size = sizeof(beambench_scene),
           .primitive_count = scene.primitives.size(),
           .vertex_count = scene.vertices.size(),
           .vertices = reinterpret_cast<const float*>(scene.vertices.data()),
           .triangle_count = scene.triangles.size(),
           .triangles = reinterpret_cast<const beambench_triangle*>(scene.triangles.data()),
           .sphere_count = spheres_.size(),
           .spheres = spheres_.data(),
           .cone_count = cones_.size(),
           .cones = cones_.data()};
}

}  // namespace beambench::plugin
