#include "scenes/animation.hpp"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes {
namespace {

bool is_valid(const glm::vec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(point[axis]) <= kLargestNumber)) return false;  // also catches NaN
  }
  return true;
}

[[noreturn]] void refuse(const Scene& scene, std::uint32_t frame, std::string_view fault) {
  throw InputError(fmt::format("{}: frame {}: {}", scene.name, frame, fault));
}

void require_size(const Scene& scene, std::uint32_t frame, std::string_view what,
                  std::size_t expected, std::size_t given) {
  if (given == expected) return;
  refuse(
      scene, frame,
      fmt::format("{} {}, but the scene has {}; all frames need the same", given, what, expected));
}

void require_points(const Scene& scene, const Pose& pose, std::uint32_t frame, PrimitiveId id) {
  const auto require = [&](std::string_view what, const glm::vec3& point) {
    if (is_valid(point)) return;
    refuse(
        scene, frame,
        fmt::format("primitive {}: {} is ({}, {}, {}); coordinates must be numbers of at most {}",
                    id, what, point.x, point.y, point.z, kLargestNumber));
  };
  const auto require_radius = [&](float expected, float given) {
    if (given == expected) return;
    refuse(
        scene, frame,
        fmt::format("primitive {}: its radius is {}, but that of the scene is {}; only positions "
                    "may change",
                    id, given, expected));
  };
  const Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case PrimitiveKind::kSphere: {
      const Sphere& sphere = pose.spheres[primitive.index];
      require("its center", sphere.center);
      require_radius(scene.spheres[primitive.index].radius, sphere.radius);
      break;
    }
    case PrimitiveKind::kCone: {
      const Cone& cone = pose.cones[primitive.index];
      require("its base", cone.base);
      require("its apex", cone.apex);
      require_radius(scene.cones[primitive.index].base_radius, cone.base_radius);
      require_radius(scene.cones[primitive.index].apex_radius, cone.apex_radius);
      break;
    }
    case PrimitiveKind::kPolygon: {
      const Polygon& polygon = scene.polygons[primitive.index];
      for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
        require("a corner", pose.vertices[scene.corners[polygon.first_corner + i]]);
        if (polygon.first_normal == Polygon::kFlat) continue;
        require("a normal", pose.normals[polygon.first_normal + i]);
      }
      break;
    }
  }
}

}  // namespace

Pose pose_of(const Scene& scene) {
  return {scene.vertices, scene.normals, scene.spheres, scene.cones};
}

void set_pose(Scene& scene, const Pose& pose, std::uint32_t frame) {
  require_size(scene, frame, "vertices", scene.vertices.size(), pose.vertices.size());
  require_size(scene, frame, "normals", scene.normals.size(), pose.normals.size());
  require_size(scene, frame, "spheres", scene.spheres.size(), pose.spheres.size());
  require_size(scene, frame, "cones", scene.cones.size(), pose.cones.size());
  for (PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    require_points(scene, pose, frame, id);
  }
  scene.vertices = pose.vertices;
  scene.normals = pose.normals;
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    scene.spheres[i].center = pose.spheres[i].center;
  }
  for (std::size_t i = 0; i < scene.cones.size(); ++i) {
    scene.cones[i].base = pose.cones[i].base;
    scene.cones[i].apex = pose.cones[i].apex;
  }
  scene.bounds = bounds_of_all(scene);
}

FrameName divide_frame(std::string_view name) {
  const std::size_t at = name.rfind('@');
  if (at == std::string_view::npos) return {name, std::nullopt};
  std::uint32_t frame = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + at + 1, end, frame);
  if (error != std::errc() || stop != end) return {name, std::nullopt};
  return {name.substr(0, at), frame};
}

void show_frame(Animation& animation, std::uint32_t frame) {
  if (frame >= animation.frames) {
    refuse(animation.scene, frame,
           animation.frames == 1
               ? "the scene does not move; it has frame 0 only"
               : fmt::format("the animation has frames 0 to {}", animation.frames - 1));
  }
  if (!animation.pose) return;
  Scene& scene = animation.scene;
  if (!scene.first_frame) scene.first_frame = std::make_shared<const Scene>(scene);
  set_pose(scene, animation.pose(frame), frame);
  scene.frame = frame;
}

}  // namespace beambench::scenes
