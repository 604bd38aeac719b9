#include "harness/rays/lights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scenes/base/portable_math.hpp"

namespace beambench::rays {
namespace {

/// The color of a light whose color is not stated.
constexpr glm::vec3 kUnsaid(1.0F);

/// Returns point i of `count` in the ball of radius 1.
glm::dvec3 point_in_ball(int i, int count) {
  constexpr double kGoldenAngle = 2.0 * std::numbers::pi / (1.0 + std::numbers::phi);
  constexpr double kWeyl = 0.7548776662466927;  // 1 / x with x^3 = x + 1
  const double z = 1.0 - (2.0 * i + 1.0) / count;
  const double across = std::sqrt(1.0 - z * z);
  const double angle = kGoldenAngle * i;
  const double inside = 0.5 + kWeyl * i;  // fraction: the volume nearer to the center
  const double radius = std::cbrt(inside - std::floor(inside));
  return radius * glm::dvec3(across * portable_cos(angle), across * portable_sin(angle), z);
}

}  // namespace

std::vector<glm::dvec3> light_colors(const scenes::Scene& scene) {
  const double share =
      1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(scene.lights.size(), 1)));
  std::vector<glm::dvec3> colors;
  colors.reserve(scene.lights.size());
  for (const scenes::Light& light : scene.lights) {
    colors.push_back(light.color == kUnsaid ? glm::dvec3(share) : glm::dvec3(light.color));
  }
  return colors;
}

std::vector<scenes::Light> area_lights(const scenes::Scene& scene, const LightExtent& extent) {
  const double diagonal = glm::length(glm::dvec3(scene.bounds.upper - scene.bounds.lower));
  const double radius = 0.5 * extent.size * diagonal;
  const std::vector<glm::dvec3> colors = light_colors(scene);
  std::vector<scenes::Light> points;
  points.reserve(scene.lights.size() * static_cast<std::size_t>(extent.points));
  for (std::size_t light = 0; light < scene.lights.size(); ++light) {
    glm::vec3 color(colors[light] / static_cast<double>(extent.points));
    if (color == kUnsaid) color.x = std::nextafter(color.x, 0.0F);  // stated, almost white
    for (int i = 0; i < extent.points; ++i) {
      const glm::dvec3 offset = radius * point_in_ball(i, extent.points);
      points.push_back({glm::vec3(glm::dvec3(scene.lights[light].position) + offset), color});
    }
  }
  return points;
}

}  // namespace beambench::rays
