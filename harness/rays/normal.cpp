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

/// Returns the normal of the lateral surface, tilted according to the change of radius along the
/// axis.
glm::dvec3 cone_normal(const scenes::Cone& cone, const glm::dvec3& point) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 along = glm::dvec3(cone.apex) - base;
  const double height = glm::length(along);
  const glm::dvec3 axis = along / height;
  const glm::dvec3 offset = point - base;
  const glm::dvec3 outward = offset - axis * glm::dot(offset, axis);
  const double distance = glm::length(outward);
  if (distance == 0.0) return axis;  // the tip, where every direction is equally valid
  const double slope = (double{cone.base_radius} - double{cone.apex_radius}) / height;
  return outward / distance + axis * slope;
}

struct TriangleCorners {
  glm::dvec3 a, b, c;

  TriangleCorners(const scenes::Scene& scene, const scenes::Triangle& triangle)
      : a(scene.vertices[triangle.vertex[0]]),
        b(scene.vertices[triangle.vertex[1]]),
        c(scene.vertices[triangle.vertex[2]]) {}

  /// Returns the normal, not of unit length.
  glm::dvec3 normal() const { return glm::cross(b - a, c - a); }
};

/// The position of a point in one triangle of a polygon.
struct Place {
  const scenes::Triangle* triangle;
  glm::dvec3 normal;              ///< not of unit length
  std::array<double, 3> weights;  ///< barycentric

  double depth() const { return std::ranges::min(weights); }
};

Place place_in(const scenes::Scene& scene, const scenes::Triangle& triangle,
               const glm::dvec3& point) {
  const TriangleCorners corners(scene, triangle);
  const auto& [a, b, c] = corners;
  const glm::dvec3 normal = corners.normal();
  const double area = glm::dot(normal, normal);
  if (area == 0.0) return {&triangle, normal, {1.0, 0.0, 0.0}};
  const double of_b = glm::dot(glm::cross(point - a, c - a), normal) / area;
  const double of_c = glm::dot(glm::cross(b - a, point - a), normal) / area;
  return {&triangle, normal, {1.0 - of_b - of_c, of_b, of_c}};
}

/// Returns the position in the triangle that contains the point with the largest margin.
Place place_in(const scenes::Scene& scene, std::span<const scenes::Triangle> triangles,
               const glm::dvec3& point) {
  Place deepest = place_in(scene, triangles.front(), point);
  for (const scenes::Triangle& triangle : triangles.subspan(1)) {
    const Place place = place_in(scene, triangle, point);
    if (place.depth() > deepest.depth()) deepest = place;
  }
  return deepest;
}

/// Returns the index of a polygon vertex's normal among the scene's normals.
std::size_t corner_of(const scenes::Scene& scene, const scenes::Polygon& polygon,
                      std::uint32_t vertex) {
  const auto corners = std::span(scene.corners).subspan(polygon.first_corner, polygon.corner_count);
  const auto corner = std::ranges::find(corners, vertex) - corners.begin();
  return polygon.first_normal + static_cast<std::size_t>(corner);
}

std::span<const scenes::Triangle> triangles_of(const scenes::Scene& scene,
                                               const scenes::Polygon& polygon) {
  return std::span(scene.triangles).subspan(polygon.first_triangle, polygon.triangle_count);
}

glm::dvec3 first_normal(const scenes::Scene& scene, const scenes::Polygon& polygon) {
  return TriangleCorners(scene, triangles_of(scene, polygon).front()).normal();
}

bool has_one_normal(const scenes::Scene& scene, const scenes::Polygon& polygon) {
  const auto unit_normal = [&](const scenes::Triangle& triangle) {
    return glm::normalize(TriangleCorners(scene, triangle).normal());
  };
  const auto triangles = triangles_of(scene, polygon);
  const glm::dvec3 first = unit_normal(triangles.front());  // NaN if it has no area
  return std::ranges::all_of(
      triangles, [&](const scenes::Triangle& triangle) { return unit_normal(triangle) == first; });
}

/// The data of a `NormalTable`, computed when used: for a few places only.
struct UntabledNormals {
  glm::dvec3 at_corner(std::size_t normal) const {
    return glm::normalize(glm::dvec3(scene->normals[normal]));
  }
  std::optional<glm::dvec3> of_plane(std::size_t polygon) const {
    const scenes::Polygon& one = scene->polygons[polygon];
    return one.triangle_count == 1 ? std::optional(first_normal(*scene, one)) : std::nullopt;
  }

  const scenes::Scene* scene;
};

/// Interpolates the corners' normals; returns the geometric normal if they cancel out.
template <class Table>
glm::dvec3 smooth_normal(const scenes::Scene& scene, const scenes::Polygon& polygon,
                         const Place& place, const Table& table) {
  glm::dvec3 normal(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    normal +=
        place.weights[i] * table.at_corner(corner_of(scene, polygon, place.triangle->vertex[i]));
  }
  return glm::length(normal) > 0.0 ? normal : place.normal;
}

template <class Table>
SurfaceNormals polygon_normals(const scenes::Scene& scene, std::size_t index,
                               const glm::dvec3& point, const Table& table) {
  const scenes::Polygon& polygon = scene.polygons[index];
  const bool is_flat = polygon.first_normal == scenes::Polygon::kFlat;
  if (is_flat) {
    if (const auto& normal = table.of_plane(index)) return {*normal, *normal};
  }
  const Place place = place_in(scene, triangles_of(scene, polygon), point);
  if (is_flat) return {place.normal, place.normal};
  return {place.normal, smooth_normal(scene, polygon, place, table)};
}

template <class Table>
SurfaceNormals normals_at(const scenes::Scene& scene, scenes::PrimitiveId id,
                          const glm::dvec3& point, const Table& table) {
  const scenes::Primitive& primitive = scene.primitives[id];
  glm::dvec3 normal;
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      normal = point - glm::dvec3(scene.spheres[primitive.index].center);
      break;
    case scenes::PrimitiveKind::kCone:
      normal = cone_normal(scene.cones[primitive.index], point);
      break;
    case scenes::PrimitiveKind::kPolygon:
      return polygon_normals(scene, primitive.index, point, table);
  }
  return {normal, normal};
}

/// Returns the unit normal on the side from which the ray comes.
glm::dvec3 facing(const glm::dvec3& normal, const glm::dvec3& direction) {
  const double length = glm::length(normal);
  // An object smaller than the rounding of t can be hit at its very center: it faces the ray.
  if (!(length > 0.0 && std::isfinite(length))) return -glm::normalize(direction);
  const glm::dvec3 unit = glm::normalize(normal);
  return glm::dot(unit, direction) > 0.0 ? -unit : unit;
}

}  // namespace

NormalTable::NormalTable(const scenes::Scene& scene)
    : corners_(scene.normals.size()), planes_(scene.polygons.size()) {
  const UntabledNormals normals{&scene};
  for (std::size_t i = 0; i < corners_.size(); ++i) corners_[i] = normals.at_corner(i);
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const scenes::Polygon& polygon = scene.polygons[i];
    if (has_one_normal(scene, polygon)) planes_[i] = first_normal(scene, polygon);
  }
}

SurfaceNormals surface_normals(const scenes::Scene& scene, scenes::PrimitiveId primitive,
                               const glm::dvec3& point, const NormalTable& table) {
  return normals_at(scene, primitive, point, table);
}

glm::dvec3 geometric_normal(const scenes::Scene& scene, const accel::Ray& ray,
                            const accel::Hit& hit) {
  const UntabledNormals normals{&scene};
  return facing(normals_at(scene, hit.primitive, hit_point(ray, hit), normals).geometric,
                glm::dvec3(ray.direction));
}

glm::dvec3 shading_normal(const scenes::Scene& scene, const accel::Ray& ray,
                          const accel::Hit& hit) {
  const UntabledNormals normals{&scene};
  return facing(normals_at(scene, hit.primitive, hit_point(ray, hit), normals).shading,
                glm::dvec3(ray.direction));
}

}  // namespace beambench::rays
