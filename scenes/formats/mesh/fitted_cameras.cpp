#include "scenes/formats/mesh/fitted_cameras.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include "scenes/bounds.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr double kMargin = 1.08;
/// The minimum distance between an eye and its target, relative to the size of the coordinates. At
/// smaller distances, the two might coincide in float.
constexpr double kMinDistance = 1e-5;

/// A direction given by its components toward the right, the top and the front of the mesh.
struct View {
  const char* name;
  glm::dvec3 from;
  glm::dvec3 up;
};

const std::array<View, 4> kViews = {{
    {"three-quarter", {0.55, 0.45, 1.0}, {0.0, 1.0, 0.0}},
    {"front", {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}},
    {"side", {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}},
    {"top", {0.0, 1.0, 0.0}, {0.0, 0.0, -1.0}},
}};

/// The axes of an image: right, top, and toward the eye.
struct ImageAxes {
  glm::dvec3 right;
  glm::dvec3 up;
  glm::dvec3 back;
};

ImageAxes image_axes(const View& view, const Orientation& mesh) {
  const glm::dvec3 right = glm::cross(mesh.up, mesh.front);
  const auto in_scene = [&](const glm::dvec3& v) {
    return v.x * right + v.y * mesh.up + v.z * mesh.front;
  };
  ImageAxes axes{};
  axes.back = glm::normalize(in_scene(view.from));
  axes.right = glm::normalize(glm::cross(in_scene(view.up), axes.back));
  axes.up = glm::cross(axes.back, axes.right);
  return axes;
}

/// The position (u, v, distance) of an eye, relative to the center, that sees all points within
/// `slope` on all sides. For a point (x, z) this means that x - u and u - x are at most slope
/// (distance - z).
struct Fit {
  double u = 0.0;
  double v = 0.0;
  double distance = 0.0;
};

Fit fit(std::span<const glm::vec3> points, const glm::dvec3& center, const ImageAxes& axes,
        double slope) {
  glm::dvec2 most(-std::numeric_limits<double>::infinity());  // of x + slope z
  glm::dvec2 least(most);                                     // of -x + slope z
  for (const glm::vec3& point : points) {
    const glm::dvec3 p = glm::dvec3(point) - center;
    const glm::dvec2 aside(glm::dot(p, axes.right), glm::dot(p, axes.up));
    const glm::dvec2 depth(slope * glm::dot(p, axes.back));
    most = glm::max(most, aside + depth);
    least = glm::max(least, depth - aside);
  }
  const glm::dvec2 shift = 0.5 * (most - least);
  const glm::dvec2 distance = 0.5 * (most + least) / slope;
  return {shift.x, shift.y, std::max(distance.x, distance.y)};
}

}  // namespace

std::vector<Camera> fitted_cameras(std::span<const glm::vec3> points,
                                   const Orientation& orientation) {
  Bounds bounds;
  for (const glm::vec3& point : points) bounds.include(point);
  if (bounds.empty()) return {};
  const glm::dvec3 center = 0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper));
  const double least = 0.5 * glm::length(glm::dvec3(bounds.extent())) +
                       kMinDistance * static_cast<double>(bounds.largest_coordinate());
  std::vector<Camera> cameras;
  for (const View& view : kViews) {
    Camera camera;
    camera.name = view.name;
    const double half_angle = 0.5 * glm::radians(static_cast<double>(camera.angle));
    const ImageAxes axes = image_axes(view, orientation);
    const Fit fitted = fit(points, center, axes, std::tan(half_angle) / kMargin);
    const glm::dvec3 at = center + fitted.u * axes.right + fitted.v * axes.up;
    const glm::dvec3 eye = at + std::max(fitted.distance, least) * axes.back;
    const glm::dvec3 size = glm::abs(eye);
    if (std::max({size.x, size.y, size.z}) > kLargestNumber) return {};
    camera.from = eye;
    camera.at = at;
    camera.up = axes.up;
    cameras.push_back(camera);
  }
  return cameras;
}

std::vector<std::string> fitted_camera_names() {
  std::vector<std::string> names;
  for (const View& view : kViews) names.emplace_back(view.name);
  return names;
}

}  // namespace beambench::scenes::mesh
