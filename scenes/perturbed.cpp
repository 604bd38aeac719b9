#include "scenes/perturbed.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#include "scenes/base/random.hpp"
#include "scenes/base/rotation.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes {
namespace {

using glm::dmat4;
using glm::dvec3;

constexpr double kMostMove = 0.05;  // share of an object's size
constexpr double kMostTurn = 10.0;  // degrees
constexpr double kCameraTurn = 15.0;
constexpr double kCameraMove = 0.1;  // share of the camera's distance
constexpr double kLargest = 0.5;     // share of the scene's size; larger objects stay in place

double size_of(const Bounds& bounds) { return glm::length(dvec3(bounds.extent())); }

/// Returns the object of each primitive, identified by the object's first primitive.
std::vector<PrimitiveId> objects_of(const Scene& scene) {
  std::vector<PrimitiveId> parent(scene.primitives.size());
  std::iota(parent.begin(), parent.end(), PrimitiveId{0});
  const auto root = [&](PrimitiveId id) {
    while (parent[id] != id) id = parent[id] = parent[parent[id]];
    return id;
  };
  std::map<std::tuple<float, float, float>, PrimitiveId> owner;
  for (PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (scene.primitives[id].kind != PrimitiveKind::kPolygon) continue;
    const Polygon& polygon = scene.polygons[scene.primitives[id].index];
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      const glm::vec3& place = scene.vertices[scene.corners[polygon.first_corner + i]];
      const auto [found, is_new] = owner.emplace(std::tuple(place.x, place.y, place.z), id);
      if (is_new) continue;
      const PrimitiveId one = root(found->second);
      const PrimitiveId other = root(id);
      parent[std::max(one, other)] = std::min(one, other);
    }
  }
  for (PrimitiveId id = 0; id < parent.size(); ++id) parent[id] = root(id);
  return parent;
}

int vertical_axis(const Camera& camera) {
  const glm::vec3 up = glm::abs(camera.up);
  return up.x > up.y && up.x > up.z ? 0 : up.y > up.z ? 1 : 2;
}

dmat4 turned_about(const dvec3& center, int axis, double degrees) {
  return moved_by(center) * rotation(axis, degrees) * moved_by(-center);
}

/// Returns a transform for each object, keyed by its first primitive.
std::map<PrimitiveId, dmat4> transforms(const Scene& scene, std::span<const PrimitiveId> object_of,
                                        Random& random) {
  std::map<PrimitiveId, Bounds> boxes;
  for (PrimitiveId id = 0; id < object_of.size(); ++id) {
    boxes[object_of[id]].include(primitive_bounds(scene, id));
  }
  const int axis = vertical_axis(scene.cameras.front());
  std::map<PrimitiveId, dmat4> result;
  for (const auto& [object, box] : boxes) {
    const double size = size_of(box);
    dvec3 offset;
    for (int i = 0; i < 3; ++i) offset[i] = random.uniform(-kMostMove, kMostMove) * size;
    const double degrees = random.uniform(-kMostTurn, kMostTurn);
    const bool stays = boxes.size() > 1 && size > kLargest * size_of(scene.bounds);
    const dvec3 center = 0.5 * (dvec3(box.lower) + dvec3(box.upper));
    result[object] = stays ? dmat4(1.0) : moved_by(offset) * turned_about(center, axis, degrees);
  }
  return result;
}

Camera varied(Camera camera, const Bounds& bounds, Random& random) {
  const double degrees = random.uniform(-kCameraTurn, kCameraTurn);
  const double nearer = random.uniform(1.0 - kCameraMove, 1.0 + kCameraMove);
  const glm::vec3& eye = camera.from;
  const bool is_inside = glm::all(glm::greaterThanEqual(eye, bounds.lower)) &&
                         glm::all(glm::lessThanEqual(eye, bounds.upper));
  const dmat4 turn = rotation(vertical_axis(camera), degrees);
  const dvec3 from_at = dvec3(turn * glm::dvec4(dvec3(camera.from) - dvec3(camera.at), 0.0));
  if (is_inside) {
    camera.at = glm::vec3(dvec3(camera.from) - from_at);
  } else {
    camera.from = glm::vec3(dvec3(camera.at) + nearer * from_at);
  }
  return camera;
}

}  // namespace

Scene perturbed(const Scene& scene, std::uint64_t seed) {
  Random random(seed);
  const std::vector<PrimitiveId> object_of = objects_of(scene);
  const std::map<PrimitiveId, dmat4> transform_of = transforms(scene, object_of, random);
  SceneBuilder builder(scene.name);
  builder.set_background(dvec3(scene.background));
  for (const Light& light : scene.lights) {
    builder.add_light(dvec3(light.position), dvec3(light.color));
  }
  for (const Camera& camera : scene.cameras) {
    builder.add_camera(varied(camera, scene.bounds, random));
  }
  std::map<std::uint32_t, std::uint32_t> vertex_of;  // each vertex is part of one object
  for (PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const Primitive& primitive = scene.primitives[id];
    const dmat4& transform = transform_of.at(object_of[id]);
    const auto place = [&](const glm::vec3& point) {
      return dvec3(transform * glm::dvec4(dvec3(point), 1.0));
    };
    builder.set_surface(scene.surfaces[primitive.surface]);
    if (primitive.kind == PrimitiveKind::kSphere) {
      const Sphere& sphere = scene.spheres[primitive.index];
      const double radius = sphere.radius;
      builder.add_sphere(place(sphere.center), sphere.inside_only ? -radius : radius);
    } else if (primitive.kind == PrimitiveKind::kCone) {
      const Cone& cone = scene.cones[primitive.index];
      const double sign = cone.inside_only ? -1.0 : 1.0;
      builder.add_cone(place(cone.base), sign * cone.base_radius, place(cone.apex),
                       sign * cone.apex_radius);
    } else {
      const Polygon& polygon = scene.polygons[primitive.index];
      std::vector<std::uint32_t> corners;
      std::vector<dvec3> normals;
      for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
        const std::uint32_t vertex = scene.corners[polygon.first_corner + i];
        const auto found = vertex_of.find(vertex);
        corners.push_back(found != vertex_of.end() ? found->second
                                                   : vertex_of[vertex] = builder.add_vertex(
                                                         place(scene.vertices[vertex])));
        if (polygon.first_normal == Polygon::kFlat) continue;
        const dvec3 normal(scene.normals[polygon.first_normal + i]);
        normals.push_back(dvec3(transform * glm::dvec4(normal, 0.0)));
      }
      builder.add_polygon(corners, normals);
    }
  }
  return std::move(builder).build();
}

}  // namespace beambench::scenes
