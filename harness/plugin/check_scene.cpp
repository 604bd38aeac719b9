#include "harness/plugin/check_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "scenes/core/plugin_error.hpp"
#include "scenes/scene_builder.hpp"
#include "scenes/scene_extent.hpp"

namespace beambench::plugin {
namespace {

void require(bool right, scenes::PrimitiveId id, std::string_view what) {
  if (right) return;
  throw PluginError(
      fmt::format("primitive {} {}; make scenes with SceneBuilder, which checks them", id, what));
}

bool is_number(float number) {
  return std::abs(number) <= static_cast<float>(scenes::kLargestNumber);
}
bool is_point(const glm::vec3& point) {
  return is_number(point.x) && is_number(point.y) && is_number(point.z);
}
bool is_radius(float radius) { return radius >= 0.0F && is_number(radius); }

/// Do `count` entries from `first` on lie within an array of that size?
bool lies_within(std::uint64_t first, std::uint64_t count, std::size_t size) {
  return first + count <= size;
}

void check_sphere(const scenes::Sphere& sphere, scenes::PrimitiveId id) {
  require(is_point(sphere.center), id, "has a center that is no point");
  require(is_radius(sphere.radius) && sphere.radius > 0.0F, id, "has a radius that is none");
}

void check_cone(const scenes::Cone& cone, scenes::PrimitiveId id) {
  require(is_point(cone.base) && is_point(cone.apex) && cone.base != cone.apex, id,
          "has an axis that is none");
  require(is_radius(cone.base_radius) && is_radius(cone.apex_radius) &&
              cone.base_radius + cone.apex_radius > 0.0F,
          id, "has radii that are none");
}

void check_polygon(const scenes::Scene& scene, const scenes::Polygon& polygon,
                   scenes::PrimitiveId id) {
  require(polygon.corner_count >= 3 &&
              lies_within(polygon.first_corner, polygon.corner_count, scene.corners.size()),
          id, "has corners that are not there");
  require(polygon.triangle_count >= 1 &&
              lies_within(polygon.first_triangle, polygon.triangle_count, scene.triangles.size()),
          id, "has triangles that are not there");
  require(polygon.first_normal == scenes::Polygon::kFlat ||
              lies_within(polygon.first_normal, polygon.corner_count, scene.normals.size()),
          id, "has normals that are not there");
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    const std::uint32_t vertex = scene.corners[polygon.first_corner + i];
    require(vertex < scene.vertices.size(), id, "has a corner that is no vertex");
    require(is_point(scene.vertices[vertex]), id, "has a corner that is no point");
  }
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
    require(triangle.primitive == id, id, "has a triangle that belongs to another");
    for (const std::uint32_t vertex : triangle.vertex) {
      require(vertex < scene.vertices.size() && is_point(scene.vertices[vertex]), id,
              "has a triangle with a corner that is no point");
    }
  }
}

void check_primitive(const scenes::Scene& scene, scenes::PrimitiveId id) {
  const scenes::Primitive& primitive = scene.primitives[id];
  require(primitive.surface < scene.surfaces.size(), id, "has a surface that is not there");
  const auto index = primitive.index;
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      require(index < scene.spheres.size(), id, "is a sphere that is not there");
      return check_sphere(scene.spheres[index], id);
    case scenes::PrimitiveKind::kCone:
      require(index < scene.cones.size(), id, "is a cone that is not there");
      return check_cone(scene.cones[index], id);
    case scenes::PrimitiveKind::kPolygon:
      require(index < scene.polygons.size(), id, "is a polygon that is not there");
      return check_polygon(scene, scene.polygons[index], id);
  }
  require(false, id, "is of no kind that there is");
}

bool is_camera(const scenes::Camera& camera) {
  return is_point(camera.from) && is_point(camera.at) && is_point(camera.up) &&
         camera.from != camera.at && camera.angle > 0.0F && camera.angle < 180.0F &&
         camera.aspect > 0.0F && std::isfinite(camera.aspect) && camera.width > 0 &&
         camera.height > 0;
}

}  // namespace

void check_scene(const scenes::Scene& scene) {
  if (scene.cameras.empty() || !std::ranges::all_of(scene.cameras, is_camera)) {
    throw PluginError("it has no camera, or one that sees nothing; make scenes with SceneBuilder");
  }
  scenes::Bounds bounds;
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    check_primitive(scene, id);
    bounds.include(scenes::primitive_bounds(scene, id));
  }
  const std::string fault = scenes::extent_fault(bounds);
  if (!fault.empty()) throw PluginError(fault);
  if (bounds.lower != scene.bounds.lower || bounds.upper != scene.bounds.upper) {
    throw PluginError("its bounds are not those of its primitives; make scenes with SceneBuilder");
  }
}

}  // namespace beambench::plugin
