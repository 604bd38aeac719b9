#include "harness/verify/contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "harness/verify/cone_contact.hpp"
#include "harness/verify/ray_line.hpp"

namespace beambench::verify {
namespace {

using glm::dvec3;

constexpr double kFar = std::numeric_limits<double>::infinity();

using Corners = std::array<dvec3, 3>;

Corners corners_of(const scenes::Scene& scene, const scenes::Triangle& triangle) {
  return {dvec3(scene.vertices[triangle.vertex[0]]), dvec3(scene.vertices[triangle.vertex[1]]),
          dvec3(scene.vertices[triangle.vertex[2]])};
}

double edge_distance(const RayLine& line, const Corners& corners) {
  return std::min({line.distance_to_segment(corners[0], corners[1]),
                   line.distance_to_segment(corners[1], corners[2]),
                   line.distance_to_segment(corners[2], corners[0])});
}

/// By how much the line passes beside the triangle; 0 through it.
double lateral_distance(const RayLine& line, const Corners& corners) {
  const dvec3 a = line.across(corners[0]);
  const dvec3 b = line.across(corners[1]);
  const dvec3 c = line.across(corners[2]);
  const auto [least, greatest] = std::minmax({glm::dot(glm::cross(a, b), line.direction),
                                              glm::dot(glm::cross(b, c), line.direction),
                                              glm::dot(glm::cross(c, a), line.direction)});
  if (least >= 0.0 || greatest <= 0.0) return 0.0;
  return edge_distance(line, corners);
}

Contact contact_with(const RayLine& line, const dvec3& point, const Corners& corners) {
  const dvec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double off_plane = std::abs(glm::dot(normal, point - corners[0]));
  return {std::max(off_plane, lateral_distance(line, corners)),
          std::abs(glm::dot(normal, line.direction)), false};
}

/// Of a polygon, the triangle that the claim fits best.
Contact contact_with(const scenes::Scene& scene, const RayLine& line, const dvec3& point,
                     const scenes::Polygon& polygon) {
  Contact best{kFar, 0.0, false};
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
    const Contact found = contact_with(line, point, corners_of(scene, triangle));
    if (found.offset < best.offset) best = found;
  }
  return best;
}

double silhouette_distance(const RayLine& line, const scenes::Sphere& sphere) {
  return std::abs(glm::length(line.across(dvec3(sphere.center))) - sphere.radius);
}

Contact contact_with(const RayLine& line, const dvec3& point, const scenes::Sphere& sphere,
                     double grazing) {
  const dvec3 from_center = point - dvec3(sphere.center);
  const double distance = glm::length(from_center);
  const double along = glm::dot(from_center, line.direction);
  Contact found{std::abs(distance - sphere.radius), std::abs(along) / distance, along > 0.0};
  if (sphere.inside_only && !found.leaving && silhouette_distance(line, sphere) > grazing) {
    found.offset = kFar;
  }
  return found;
}

}  // namespace

Contact contact(const scenes::Scene& scene, const accel::Ray& ray,
                const accel::embree::ExactHit& hit, double grazing) {
  const RayLine line(ray);
  const dvec3 point = dvec3(ray.origin) + hit.t * dvec3(ray.direction);
  const scenes::Primitive& primitive = scene.primitives[hit.primitive];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return contact_with(line, point, scene.spheres[primitive.index], grazing);
    case scenes::PrimitiveKind::kCone:
      return cone_contact(line, point, scene.cones[primitive.index], grazing);
    case scenes::PrimitiveKind::kPolygon:
      return contact_with(scene, line, point, scene.polygons[primitive.index]);
  }
  return {kFar, 0.0, false};
}

double boundary_distance(const scenes::Scene& scene, const accel::Ray& ray,
                         scenes::PrimitiveId id) {
  const RayLine line(ray);
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return silhouette_distance(line, scene.spheres[primitive.index]);
    case scenes::PrimitiveKind::kCone:
      return cone_boundary_distance(line, scene.cones[primitive.index]);
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  double nearest = kFar;
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
    nearest = std::min(nearest, edge_distance(line, corners_of(scene, triangle)));
  }
  return nearest;
}

}  // namespace beambench::verify
