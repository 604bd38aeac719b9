#include "harness/rays/normal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

namespace beambench::rays {
namespace {

glm::dvec3 hit_point(const accel::Ray& ray, const accel::Hit& hit) {
  return glm::dvec3(ray.origin) + double{hit.t} * glm::dvec3(ray.direction);
}

/// The lateral surface leans by the change of its radius along the axis.
glm::dvec3 cone_normal(const scenes::Cone& cone, const glm::dvec3& point) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 along = glm::dvec3(cone.apex) - base;
  const double height = glm::length(along);
  const glm::dvec3 axis = along / height;
  const glm::dvec3 offset = point - base;
  const glm::dvec3 outward = offset - axis * glm::dot(offset, axis);
  const double distance = glm::length(outward);
  if (distance == 0.0) return axis;  // the tip, where every direction is as good
  const double slope = (double{cone.base_radius} - double{cone.apex_radius}) / height;
  return outward / distance + axis * slope;
}

/// Where a point lies in one triangle of a polygon.
struct Place {
  std::array<double, 3> weights{1.0, 0.0, 0.0};  ///< barycentric
  glm::dvec3 normal{0.0, 0.0, 1.0};              ///< not of unit length
  const scenes::Triangle* triangle = nullptr;

  double depth() const { return *std::min_element(weights.begin(), weights.end()); }
};

Place place_in(const scenes::Scene& scene, const scenes::Triangle& triangle,
               const glm::dvec3& point) {
  const glm::dvec3 a(scene.vertices[triangle.vertex[0]]);
  const glm::dvec3 b(scene.vertices[triangle.vertex[1]]);
  const glm::dvec3 c(scene.vertices[triangle.vertex[2]]);
  Place place;
  place.triangle = &triangle;
  place.normal = glm::cross(b - a, c - a);
  const double area = glm::dot(place.normal, place.normal);
  if (area == 0.0) return place;
  const double of_b = glm::dot(glm::cross(point - a, c - a), place.normal) / area;
  const double of_c = glm::dot(glm::cross(b - a, point - a), place.normal) / area;
  place.weights = {1.0 - of_b - of_c, of_b, of_c};
  return place;
}

Place place_in(const scenes::Scene& scene, const scenes::Polygon& polygon,
               const glm::dvec3& point) {
  const auto triangles =
      std::span(scene.triangles).subspan(polygon.first_triangle, polygon.triangle_count);
  Place deepest = place_in(scene, triangles.front(), point);
  for (const scenes::Triangle& triangle : triangles.subspan(1)) {
    const Place place = place_in(scene, triangle, point);
    if (place.depth() > deepest.depth()) deepest = place;
  }
  return deepest;
}

glm::dvec3 corner_normal(const scenes::Scene& scene, const scenes::Polygon& polygon,
                         std::uint32_t vertex) {
  const auto corners = std::span(scene.corners).subspan(polygon.first_corner, polygon.corner_count);
  const auto corner = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
  const glm::vec3& normal = scene.normals[polygon.first_normal + static_cast<std::size_t>(corner)];
  return glm::normalize(glm::dvec3(normal));  // a file's normals may have any length
}

glm::dvec3 polygon_normal(const scenes::Scene& scene, const scenes::Polygon& polygon,
                          const glm::dvec3& point, bool smooth) {
  const Place place = place_in(scene, polygon, point);
  if (!smooth || polygon.first_normal == scenes::Polygon::kFlat) return place.normal;
  glm::dvec3 normal(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    normal += place.weights[i] * corner_normal(scene, polygon, place.triangle->vertex[i]);
  }
  return glm::length(normal) > 0.0 ? normal : place.normal;
}

glm::dvec3 facing_normal(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit,
                         bool smooth) {
  const scenes::Primitive& primitive = scene.primitives[hit.primitive];
  const glm::dvec3 point = hit_point(ray, hit);
  glm::dvec3 normal;
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      normal = point - glm::dvec3(scene.spheres[primitive.index].center);
      break;
    case scenes::PrimitiveKind::kCone:
      normal = cone_normal(scene.cones[primitive.index], point);
      break;
    case scenes::PrimitiveKind::kPolygon:
      normal = polygon_normal(scene, scene.polygons[primitive.index], point, smooth);
      break;
  }
  const glm::dvec3 direction(ray.direction);
  const double length = glm::length(normal);
  // What is smaller than the rounding of t can be hit in its very center: it faces the ray.
  if (!(length > 0.0 && std::isfinite(length))) return -glm::normalize(direction);
  normal = glm::normalize(normal);
  return glm::dot(normal, direction) > 0.0 ? -normal : normal;
}

}  // namespace

glm::dvec3 geometric_normal(const scenes::Scene& scene, const accel::Ray& ray,
                            const accel::Hit& hit) {
  return facing_normal(scene, ray, hit, false);
}

glm::dvec3 shading_normal(const scenes::Scene& scene, const accel::Ray& ray,
                          const accel::Hit& hit) {
  return facing_normal(scene, ray, hit, true);
}

}  // namespace beambench::rays
