#pragma once
// How a claimed hit sits on the primitive it names: the geometry behind the differ's classes.

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "accel/embree/oracle.hpp"
#include "scenes/primitive.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// The line of a ray, in double and with a direction of unit length.
struct RayLine {
  explicit RayLine(const accel::Ray& ray)
      : origin(ray.origin), direction(glm::normalize(glm::dvec3(ray.direction))) {}

  /// From the line to the point, perpendicular to the line.
  glm::dvec3 across(const glm::dvec3& point) const {
    const glm::dvec3 offset = point - origin;
    return offset - glm::dot(offset, direction) * direction;
  }
  double distance_to(const glm::dvec3& point) const { return glm::length(across(point)); }
  double distance_to_segment(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 a = across(from);
    const glm::dvec3 edge = across(to) - a;
    const double length_2 = glm::dot(edge, edge);
    const double at = length_2 > 0.0 ? std::clamp(-glm::dot(a, edge) / length_2, 0.0, 1.0) : 0.0;
    return glm::length(a + at * edge);
  }

  glm::dvec3 origin;
  glm::dvec3 direction;
};

/// A claimed hit measured against its primitive, in double.
struct Contact {
  /// How far the claim is from a true hit: the larger of the distance of the point at t from the
  /// primitive's surface (continued beyond its boundary) and the distance by which the ray passes
  /// beside the primitive. Infinite where the ray may not hit at all: at the entry into a primitive
  /// that is seen from the inside only.
  double offset;
  /// |cos| of the angle between the ray and the surface normal there.
  double cosine;
  /// Does the ray leave the sphere or cone there? False for polygons, which have no inside.
  bool leaving;
};

/// `grazing` is the distance from a silhouette within which entry and exit cannot be told apart.
Contact contact(const scenes::Scene& scene, const accel::Ray& ray,
                const accel::embree::ExactHit& hit, double grazing);

/// The distance from the line of the ray to the primitive's boundary as the ray sees it: the
/// nearest edge of a polygon's triangles, the silhouette of a sphere, silhouette or rims of a cone.
double boundary_distance(const scenes::Scene& scene, const accel::Ray& ray,
                         scenes::PrimitiveId primitive);

Contact cone_contact(const RayLine& line, const glm::dvec3& point, const scenes::Cone& cone,
                     double grazing);
double cone_boundary_distance(const RayLine& line, const scenes::Cone& cone);

}  // namespace beambench::verify
