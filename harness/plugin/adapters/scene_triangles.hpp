#pragma once
// A scene as libraries for triangles take it.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <beambench/plugin.hpp>

namespace adapters {

/// The three corners of triangle `index`, which is part of a polygon's surface.
inline std::array<glm::vec3, 3> corners(const beambench::Scene& scene, std::size_t index) {
  const auto& vertex = scene.triangles[index].vertex;
  return {scene.vertices[vertex[0]], scene.vertices[vertex[1]], scene.vertices[vertex[2]]};
}

/// Throws InputError when the scene holds something else.
inline void require_triangles_only(const beambench::Scene& scene, const std::string& structure) {
  if (scene.spheres.empty() && scene.cones.empty()) return;
  throw beambench::InputError(structure + " takes triangles, and '" + scene.name +
                              "' holds spheres or cones; choose a scene of polygons");
}

/// Libraries compute t in float in a way of their own, and the differ would not always pass it. The
/// canonical test of the triangle that was found tells it to the last bit, or that there is no hit
/// after all.
inline std::optional<beambench::Hit> confirmed(const beambench::Scene& scene,
                                               const beambench::Ray& ray, std::size_t triangle) {
  const beambench::CanonicalRay canonical(ray);
  const auto [a, b, c] = corners(scene, triangle);
  const float t = beambench::intersect_triangle(canonical, a, b, c);
  if (!beambench::is_hit(t)) return std::nullopt;
  return beambench::Hit{t, scene.triangles[triangle].primitive};
}

/// The parameter that turns it off.
inline beambench::ParameterInfo confirm_parameter() {
  return beambench::flag_parameter(
      "confirm", true, "t of a hit by beambench's own test of the triangle that was found");
}

}  // namespace adapters
