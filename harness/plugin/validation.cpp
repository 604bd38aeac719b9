#include "harness/plugin/validation.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/scene_builder.hpp"

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

/// Returns whether the `count` entries that start at `first` lie within an array of that size.
bool lies_within(std::uint64_t first, std::uint64_t count, std::size_t size) {
  return first + count <= size;
}

void check_sphere(const scenes::Sphere& sphere, scenes::PrimitiveId id) {
  require(is_point(sphere.center), id, "has a center that is not a point");
  require(is_radius(sphere.radius) && sphere.radius > 0.0F, id, "has an invalid radius");
}

void check_cone(const scenes::Cone& cone, scenes::PrimitiveId id) {
  require(is_point(cone.base) && is_point(cone.apex) && cone.base != cone.apex, id,
          "has an invalid axis");
  require(is_radius(cone.base_radius) && is_radius(cone.apex_radius) &&
              cone.base_radius + cone.apex_radius > 0.0F,
          id, "has invalid radii");
}

void check_polygon(const scenes::Scene& scene, const scenes::Polygon& polygon,
                   scenes::PrimitiveId id) {
  require(polygon.corner_count >= 3 &&
              lies_within(polygon.first_corner, polygon.corner_count, scene.corners.size()),
          id, "has corners that do not exist");
  require(polygon.triangle_count >= 1 &&
              lies_within(polygon.first_triangle, polygon.triangle_count, scene.triangles.size()),
          id, "has triangles that do not exist");
  require(polygon.first_normal == scenes::Polygon::kFlat ||
              lies_within(polygon.first_normal, polygon.corner_count, scene.normals.size()),
          id, "has normals that do not exist");
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    const std::uint32_t vertex = scene.corners[polygon.first_corner + i];
    require(vertex < scene.vertices.size(), id, "has a corner that is not a vertex");
    require(is_point(scene.vertices[vertex]), id, "has a corner that is not a point");
  }
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
    require(triangle.primitive == id, id, "has a triangle that is part of another primitive");
    for (const std::uint32_t vertex : triangle.vertex) {
      require(vertex < scene.vertices.size() && is_point(scene.vertices[vertex]), id,
              "has a triangle with a corner that is not a point");
    }
  }
}

void check_primitive(const scenes::Scene& scene, scenes::PrimitiveId id) {
  const scenes::Primitive& primitive = scene.primitives[id];
  require(primitive.surface < scene.surfaces.size(), id, "has a surface that does not exist");
  const auto index = primitive.index;
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      require(index < scene.spheres.size(), id, "refers to a sphere that does not exist");
      return check_sphere(scene.spheres[index], id);
    case scenes::PrimitiveKind::kCone:
      require(index < scene.cones.size(), id, "refers to a cone that does not exist");
      return check_cone(scene.cones[index], id);
    case scenes::PrimitiveKind::kPolygon:
      require(index < scene.polygons.size(), id, "refers to a polygon that does not exist");
      return check_polygon(scene, scene.polygons[index], id);
  }
  require(false, id, "is of an unknown kind");
}

bool is_camera(const scenes::Camera& camera) {
  return is_point(camera.from) && is_point(camera.at) && is_point(camera.up) &&
         camera.from != camera.at && camera.angle > 0.0F && camera.angle < 180.0F &&
         camera.aspect > 0.0F && std::isfinite(camera.aspect) && camera.width > 0 &&
         camera.height > 0;
}

/// Names with a special meaning in commands.
constexpr std::array<std::string_view, 2> kReserved{"all", "oracle"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) && std::ranges::all_of(text, [](char c) {
    return is_letter(c) || is_digit(c) || c == '-' || c == '_';
  });
}

/// The names of all structures, scenes or parameters; each name may occur only once.
class Names {
 public:
  Names(std::string_view what, std::set<std::string> taken)
      : what_(what), taken_(std::move(taken)) {}

  void take(const std::string& name) {
    if (!is_name(name) || std::ranges::find(kReserved, name) != kReserved.end()) {
      throw PluginError(
          fmt::format("names a {} '{}', which is not a valid name; use letters, digits, '-' and "
                      "'_', a letter first, "
                      "and neither 'all' nor 'oracle'",
                      what_, name));
    }
    if (!taken_.insert(name).second) {
      throw PluginError(
          fmt::format("provides a {} '{}', but there is one of that name already; "
                      "rename it",
                      what_, name));
    }
  }

 private:
  std::string_view what_;
  std::set<std::string> taken_;
};

template <class Infos>
std::set<std::string> names_of(const Infos& infos) {
  std::set<std::string> names;
  for (const auto& info : infos) names.insert(info.name);
  return names;
}

void require(bool right, std::string_view what, const std::string& name, std::string_view lack) {
  if (!right) throw PluginError(fmt::format("provides a {} '{}' {}", what, name, lack));
}

/// Checks parameters: each default must pass the same check as a user's value.
void check_parameters(std::string_view what, const std::string& owner,
                      const std::vector<ParameterInfo>& infos) {
  Names names(fmt::format("parameter of '{}'", owner), {});
  std::vector<std::pair<std::string, std::string>> defaults;
  for (const ParameterInfo& info : infos) {
    names.take(info.name);
    defaults.emplace_back(info.name, info.default_value);
  }
  try {
    const Parameters checked(owner, infos, defaults);
  } catch (const std::exception& error) {
    throw PluginError(fmt::format("provides a {} '{}' with invalid default parameters: {}", what,
                                  owner, error.what()));
  }
}

void check_reader(const scenes::SceneReader& reader, std::set<std::string>& endings) {
  const std::string& ending = reader.ending;
  const bool sound = ending.size() > 1 && ending.front() == '.' &&
                     std::ranges::all_of(ending, [](unsigned char c) {
                       return c == '.' || std::isdigit(c) != 0 || std::islower(c) != 0;
                     });
  require(sound, "reader of files", ending,
          "with an invalid ending: it must be a dot, then lowercase letters and digits");
  require(!scenes::is_scene_file("file" + ending) && endings.insert(ending).second,
          "reader of files", ending, "for files that can be read already");
  require(!reader.summary.empty(), "reader of files", ending, "without a summary");
  require(static_cast<bool>(reader.read), "reader of files", ending, "without a function to read");
}

}  // namespace

void check_scene(const scenes::Scene& scene) {
  if (scene.cameras.empty() || !std::ranges::all_of(scene.cameras, is_camera)) {
    throw PluginError("it has no camera, or an invalid camera; make scenes with SceneBuilder");
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

void check_contents(const PluginContents& contents) {
  if (contents.structures.empty() && contents.scenes.empty() && contents.readers.empty()) {
    throw PluginError("provides nothing: no structures, scenes or file readers");
  }
  Names structures("structure", names_of(accel::registry().structures()));
  for (const accel::StructureInfo& info : contents.structures) {
    structures.take(info.name);
    require(!info.summary.empty(), "structure", info.name, "without a summary");
    require(static_cast<bool>(info.build), "structure", info.name, "without a function to build");
    check_parameters("structure", info.name, info.parameters);
  }
  Names scenes("scene", names_of(scenes::scene_catalogue()));
  for (const scenes::SceneInfo& info : contents.scenes) {
    scenes.take(info.name);
    require(!info.summary.empty(), "scene", info.name, "without a summary");
    require(static_cast<bool>(info.generate), "scene", info.name, "without a function to generate");
    require(!info.animate, "scene", info.name, "that moves; only built-in scenes may move");
    check_parameters("scene", info.name, info.parameters);
  }
  std::set<std::string> endings;
  for (const scenes::SceneReader& reader : contents.readers) check_reader(reader, endings);
}

}  // namespace beambench::plugin
