#pragma once
// The normal of a surface where a ray meets it.

#include <optional>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// The unit normal of the primitive hit, at the hit, on the side that the ray comes from. On a
/// polygon: that of the triangle in which the point lies deepest.
glm::dvec3 geometric_normal(const scenes::Scene& scene, const accel::Ray& ray,
                            const accel::Hit& hit);

/// The same, but on a smooth polygon interpolated between the corners' normals: what shading uses.
glm::dvec3 shading_normal(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit);

/// Both of them, of any length and on either side of the surface.
struct SurfaceNormals {
  glm::dvec3 geometric;
  glm::dvec3 shading;
};

/// What normals of many places need of a scene, computed once.
class NormalTable {
 public:
  explicit NormalTable(const scenes::Scene& scene);

  /// The unit normal at a corner of a smooth polygon: a file's may have any length.
  const glm::dvec3& at_corner(std::size_t normal) const { return corners_[normal]; }
  /// The normal of a polygon all of whose triangles have the same unit normal, to the last bit:
  /// that of the first of them, not of unit length. Nothing for others.
  const std::optional<glm::dvec3>& of_plane(std::size_t polygon) const { return planes_[polygon]; }

 private:
  std::vector<glm::dvec3> corners_;
  std::vector<std::optional<glm::dvec3>> planes_;
};

/// At a point of a primitive; the table is the scene's.
SurfaceNormals surface_normals(const scenes::Scene& scene, scenes::PrimitiveId primitive,
                               const glm::dvec3& point, const NormalTable& table);

}  // namespace beambench::rays
