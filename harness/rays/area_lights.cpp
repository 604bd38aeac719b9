#include "harness/rays/area_lights.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace beambench::rays {
namespace {

/// Returns point i of `count` in the ball of radius 1.
glm::dvec3 point_in_ball(int i, int count) {
  constexpr double kGoldenAngle = 2.0 * std::numbers::pi / (1.0 + std::numbers::phi);
  constexpr double kWeyl = 0.7548776662466927;  // 1 / x with x^3 = x + 1
  const double z = 1.0 - (2.0 * i + 1.0) / count;
  const double across = std::sqrt(1.0 - z * z);
  const double angle = kGoldenAngle * i;
  const double inside = 0.5 + kWeyl * i;  // its fraction: the volume nearer to the center
  const double radius = std::cbrt(inside - std::floor(inside));
  return radius * glm::dvec3(across * std::cos(angle), across * std::sin(angle), z);
}

}  // namespace

std::vector<scenes::Light> area_lights(const scenes::Scene& scene, const LightExtent& extent) {
  const double diagonal = glm::length(glm::dvec3(scene.bounds.upper - scene.bounds.lower));
  const double radius = 0.5 * extent.size * diagonal;
  const auto share = static_cast<float>(1.0 / std::sqrt(static_cast<double>(extent.points)));
  std::vector<scenes::Light> points;
  points.reserve(scene.lights.size() * static_cast<std::size_t>(extent.points));
  for (const scenes::Light& light : scene.lights) {
    for (int i = 0; i < extent.points; ++i) {
      const glm::dvec3 place =
          glm::dvec3(light.position) + radius * point_in_ball(i, extent.points);
      points.push_back({glm::vec3(place), share * light.color});
    }
  }
  return points;
}

}  // namespace beambench::rays
