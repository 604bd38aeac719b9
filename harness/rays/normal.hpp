#pragma once
// Computes the normal of a surface where a ray meets it.

#include <optional>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Returns the unit normal of the primitive at the hit, on the side from which the ray comes. For a
/// polygon, this is the normal of the triangle that contains the point with the largest margin.
glm::dvec3 geometric_normal(const scenes::Scene& scene, const accel::Ray& ray,
                            const accel::Hit& hit);

/// Returns the same normal, except that on a smooth polygon it is interpolated between the corners,
/// for shading.
glm::dvec3 shading_normal(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit);

/// Both normals, of any length and on either side of the surface.
struct SurfaceNormals {
  glm::dvec3 geometric;
  glm::dvec3 shading;
};

/// Data of a scene for computing normals at many places; built once.
class NormalTable {
 public:
  explicit NormalTable(const scenes::Scene& scene);

  /// Returns the unit normal at a corner of a smooth polygon. (Normals in a file may have any
  /// length.)
  const glm::dvec3& at_corner(std::size_t normal) const { return corners_[normal]; }
  /// Returns the normal of a polygon whose triangles all have the same unit normal, to the last
  /// bit: that of the first triangle, not of unit length. Returns nothing for other polygons.
  const std::optional<glm::dvec3>& of_plane(std::size_t polygon) const { return planes_[polygon]; }

 private:
  std::vector<glm::dvec3> corners_;
  std::vector<std::optional<glm::dvec3>> planes_;
};

/// Returns the normals at a point of a primitive; the table belongs to the scene.
SurfaceNormals surface_normals(const scenes::Scene& scene, scenes::PrimitiveId primitive,
                               const glm::dvec3& point, const NormalTable& table);

}  // namespace beambench::rays
