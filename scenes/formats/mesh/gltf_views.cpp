#include "scenes/formats/mesh/gltf_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scenes/base/error.hpp"
#include "scenes/formats/mesh/fitted_cameras.hpp"
#include "scenes/formats/mesh/gltf_file.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::mesh {
namespace {

glm::dvec3 center_of(const Bounds& bounds) {
  return 0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper));
}

double radius_of(const Bounds& bounds) {
  return 0.5 * glm::length(glm::dvec3(bounds.upper) - glm::dvec3(bounds.lower));
}

/// Returns the name reduced to the characters that a camera's name may have (see
/// `SceneBuilder::add_camera`).
std::string plain_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == '\x7F' || c == '#'; },
      '_');
  const std::size_t first = name.find_first_not_of(' ');
  if (first == std::string::npos) return "camera";
  return name.substr(first, name.find_last_not_of(' ') - first + 1);
}

/// Returns the name, followed if necessary by the first number that makes it unique.
std::string distinct_name(const std::string& name, const std::vector<Camera>& before) {
  const auto fitted = fitted_camera_names();
  const auto is_taken = [&](const std::string& text) {
    return std::find(fitted.begin(), fitted.end(), text) != fitted.end() ||
           std::any_of(before.begin(), before.end(),
                       [&](const Camera& camera) { return camera.name == text; });
  };
  std::string distinct = name;
  for (int number = 2; is_taken(distinct); ++number) distinct = fmt::format("{} {}", name, number);
  return distinct;
}

/// Returns why a scene cannot contain the camera; empty if it can.
std::string fault_of(const Camera& camera) {
  try {
    SceneBuilder("").add_camera(camera);
    return "";
  } catch (const InputError& error) {
    const std::string message = error.what();  // "camera 0: ..."
    return message.substr(message.find(": ") + 2);
  }
}

Camera placed_camera(const tinygltf::PerspectiveCamera& lens, const PlacedNode& node,
                     const Bounds& bounds) {
  const glm::dvec3 eye(node.to_world[3]);
  const glm::dvec3 forward = glm::normalize(-glm::dvec3(node.to_world[2]));
  // The target is as far away as the scene's center, but far enough to differ from the eye in
  // float.
  const double least = std::max(1e-3 * radius_of(bounds), 1e-4 * glm::length(eye));
  const double depth = std::max(glm::dot(center_of(bounds) - eye, forward), least);
  Camera camera;
  camera.from = eye;
  camera.at = eye + depth * forward;
  camera.up = glm::normalize(glm::dvec3(node.to_world[1]));
  camera.angle = static_cast<float>(glm::degrees(lens.yfov));
  if (lens.aspectRatio > 0.0) camera.aspect = static_cast<float>(lens.aspectRatio);
  if (camera.aspect >= 1e-3F && camera.aspect <= 100.0F) {
    camera.width = std::max(
        1, static_cast<int>(std::lround(camera.aspect * static_cast<float>(camera.height))));
  }
  return camera;
}

/// A placed light, with its linear brightness at the scene's center.
struct PlacedLight {
  glm::dvec3 position;
  glm::dvec3 color;
};

double brightest(const glm::dvec3& color) { return std::max({color.x, color.y, color.z}); }

/// Returns the index of a node's light; -1 if it has none.
int light_of(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_lights_punctual");
  if (found == node.extensions.end() || !found->second.Has("light")) return -1;
  const tinygltf::Value& light = found->second.Get("light");
  return light.IsNumber() ? light.GetNumberAsInt() : -1;
}

PlacedLight placed_light(const tinygltf::Light& light, const PlacedNode& node,
                         const Bounds& bounds) {
  const glm::dvec3 center = center_of(bounds);
  const double radius = radius_of(bounds);
  glm::dvec3 color(1.0);
  for (std::size_t i = 0; i < std::min<std::size_t>(light.color.size(), 3); ++i) {
    color[static_cast<int>(i)] = light.color[i];
  }
  color = glm::max(color * light.intensity, 0.0);
  if (light.type == "directional") {
    constexpr double kFar = 1000.0;  // radii: its rays differ by less than 0.1 degrees
    const glm::dvec3 backward = glm::normalize(glm::dvec3(node.to_world[2]));
    return {center + kFar * radius * backward, color};
  }
  const glm::dvec3 position(node.to_world[3]);
  const double distance = std::max(glm::distance(position, center), 0.1 * radius);
  return {position, color / (distance * distance)};
}

bool is_valid(const PlacedLight& light) {
  const glm::dvec3 size = glm::abs(light.position);
  const double peak = brightest(light.color);
  return std::max({size.x, size.y, size.z}) <= kLargestNumber && peak > 0.0 &&
         std::isfinite(peak) && std::isfinite(light.color.x + light.color.y + light.color.z) &&
         std::isfinite(size.x + size.y + size.z);
}

}  // namespace

std::vector<Camera> gltf_cameras(const tinygltf::Model& model, std::span<const PlacedNode> nodes,
                                 const Bounds& bounds, std::vector<std::string>& warnings) {
  std::vector<Camera> cameras;
  for (const PlacedNode& placed : nodes) {
    if (placed.node->camera < 0) continue;
    const tinygltf::Camera& found =
        element_of(model.cameras, placed.node->camera, "camera", "a node");
    const std::string name = plain_name(placed.node->name.empty() ? found.name : placed.node->name);
    if (found.type != "perspective") {
      warnings.push_back(fmt::format("the camera '{}' was left out: it is not perspective", name));
      continue;
    }
    Camera camera = placed_camera(found.perspective, placed, bounds);
    camera.name = distinct_name(name, cameras);
    const std::string fault = fault_of(camera);
    if (fault.empty()) {
      cameras.push_back(camera);
    } else {
      warnings.push_back(fmt::format("the camera '{}' was left out: {}", name, fault));
    }
  }
  return cameras;
}

std::vector<Light> gltf_lights(const tinygltf::Model& model, std::span<const PlacedNode> nodes,
                               const Bounds& bounds, std::vector<std::string>& warnings) {
  std::vector<PlacedLight> placed;
  std::size_t spots = 0;
  std::size_t invalid = 0;
  double squares = 0.0;
  for (const PlacedNode& node : nodes) {
    const int number = light_of(*node.node);
    if (number < 0) continue;
    const tinygltf::Light& found = element_of(model.lights, number, "light", "a node");
    const PlacedLight light = placed_light(found, node, bounds);
    if (!is_valid(light)) {
      ++invalid;
      continue;
    }
    if (found.type == "spot") ++spots;
    squares += brightest(light.color) * brightest(light.color);
    placed.push_back(light);
  }
  if (spots > 0) warnings.push_back(fmt::format("{} spot lights shine in all directions", spots));
  if (invalid > 0) {
    warnings.push_back(
        fmt::format("{} lights were left out: they emit no light, or are beyond 1e9", invalid));
  }
  std::vector<Light> lights;
  for (const PlacedLight& light : placed) {
    lights.push_back({glm::vec3(light.position), glm::vec3(light.color / std::sqrt(squares))});
  }
  return lights;
}

}  // namespace beambench::scenes::mesh
