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

struct TriangleCorners {
  glm::dvec3 a, b, c;

  TriangleCorners(const scenes::Scene& scene, const scenes::Triangle& triangle)
      : a(scene.vertices[triangle.vertex[0]]),
        b(scene.vertices[triangle.vertex[1]]),
        c(scene.vertices[triangle.vertex[2]]) {}

  /// Not of unit length.
  glm::dvec3 normal() const { return glm::cross(b - a, c - a); }
};

/// Where a point lies in a triangle, in barycentric coordinates.
std::array<double, 3> weights_in(const TriangleCorners& corners, const glm::dvec3& point) {
  const auto& [a, b, c] = corners;
  const glm::dvec3 normal = corners.normal();
  const double area = glm::dot(normal, normal);
  if (area == 0.0) return {1.0, 0.0, 0.0};
  const double of_b = glm::dot(glm::cross(point - a, c - a), normal) / area;
  const double of_c = glm::dot(glm::cross(b - a, point - a), normal) / area;
  return {1.0 - of_b - of_c, of_b, of_c};
}

/// The triangle of a polygon in which a point lies deepest.
const scenes::Triangle& deepest_triangle(const scenes::Scene& scene, const scenes::Polygon& polygon,
                                         const glm::dvec3& point) {
  const auto triangles =
      std::span(scene.triangles).subspan(polygon.first_triangle, polygon.triangle_count);
  if (triangles.size() == 1) return triangles.front();
  return *std::ranges::max_element(triangles, {}, [&](const scenes::Triangle& triangle) {
    return std::ranges::min(weights_in({scene, triangle}, point));
  });
}

glm::dvec3 corner_normal(const scenes::Scene& scene, const scenes::Polygon& polygon,
                         std::uint32_t vertex) {
  const auto corners = std::span(scene.corners).subspan(polygon.first_corner, polygon.corner_count);
  const auto corner = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
  const glm::vec3& normal = scene.normals[polygon.first_normal + static_cast<std::size_t>(corner)];
  return glm::normalize(glm::dvec3(normal));  // a file's normals may have any length
}

/// Interpolated between the corners' normals; not of unit length. The geometric one where they
/// cancel out.
glm::dvec3 smooth_normal(const scenes::Scene& scene, const scenes::Polygon& polygon,
                         const scenes::Triangle& triangle, const glm::dvec3& point) {
  const TriangleCorners corners(scene, triangle);
  const std::array<double, 3> weights = weights_in(corners, point);
  glm::dvec3 normal(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    normal += weights[i] * corner_normal(scene, polygon, triangle.vertex[i]);
  }
  return glm::length(normal) > 0.0 ? normal : corners.normal();
}

/// Of unit length, on the side that the ray comes from.
glm::dvec3 facing(const glm::dvec3& normal, const glm::dvec3& direction) {
  const double length = glm::length(normal);
  // What is smaller than the rounding of t can be hit in its very center: it faces the ray.
  if (!(length > 0.0 && std::isfinite(length))) return -glm::normalize(direction);
  const glm::dvec3 unit = glm::normalize(normal);
  return glm::dot(unit, direction) > 0.0 ? -unit : unit;
}

}  // namespace

SurfaceNormals surface_normals(const scenes::Scene& scene, const accel::Ray& ray,
                               const accel::Hit& hit) {
  const scenes::Primitive& primitive = scene.primitives[hit.primitive];
  const glm::dvec3 direction(ray.direction);
  const glm::dvec3 point = hit_point(ray, hit);
  glm::dvec3 normal;
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      normal = facing(point - glm::dvec3(scene.spheres[primitive.index].center), direction);
      break;
    case scenes::PrimitiveKind::kCone:
      normal = facing(cone_normal(scene.cones[primitive.index], point), direction);
      break;
    case scenes::PrimitiveKind::kPolygon: {
      const scenes::Polygon& polygon = scene.polygons[primitive.index];
      const scenes::Triangle& triangle = deepest_triangle(scene, polygon, point);
      normal = facing(TriangleCorners(scene, triangle).normal(), direction);
      if (polygon.first_normal == scenes::Polygon::kFlat) break;
      return {normal, facing(smooth_normal(scene, polygon, triangle, point), direction)};
    }
  }
  return {normal, normal};
}

glm::dvec3 geometric_normal(const scenes::Scene& scene, const accel::Ray& ray,
                            const accel::Hit& hit) {
  return surface_normals(scene, ray, hit).geometric;
}

glm::dvec3 shading_normal(const scenes::Scene& scene, const accel::Ray& ray,
                          const accel::Hit& hit) {
  return surface_normals(scene, ray, hit).shading;
}

}  // namespace beambench::rays
