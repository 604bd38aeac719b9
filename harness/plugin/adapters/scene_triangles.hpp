#pragma once
// A scene in the form that triangle libraries need.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <beambench/plugin.hpp>
#include <glm/geometric.hpp>

namespace adapters {

/// Returns the three corners of triangle `index`, which is part of a polygon's surface.
inline std::array<glm::vec3, 3> corners(const beambench::scenes::Scene& scene, std::size_t index) {
  const auto& vertex = scene.triangles[index].vertex;
  return {scene.vertices[vertex[0]], scene.vertices[vertex[1]], scene.vertices[vertex[2]]};
}

/// Throws InputError if the scene contains anything except triangles.
inline void require_triangles_only(const beambench::scenes::Scene& scene,
                                   const std::string& structure) {
  if (scene.spheres.empty() && scene.cones.empty()) return;
  throw beambench::InputError(structure + " supports only triangles, but '" + scene.name +
                              "' contains spheres or cones; choose a scene of polygons");
}

/// Returns a hit that a library found, with an accurate t. Libraries compute t in float with their
/// own formulas, and the differ would not accept every result. Therefore t is computed in double,
/// from the triangle's plane. Whether the triangle is hit remains the library's decision: next to
/// an edge, beambench's own test might reject the ray, and the hit would be lost.
inline beambench::accel::Hit with_exact_t(const beambench::scenes::Scene& scene,
                                          const beambench::accel::Ray& ray, std::size_t triangle,
                                          float t) {
  const beambench::accel::CanonicalRay canonical(ray);
  const auto [a, b, c] = corners(scene, triangle);
  const glm::dvec3 from(a);
  const glm::dvec3 normal = glm::cross(glm::dvec3(b) - from, glm::dvec3(c) - from);
  const float exact = canonical.accept(glm::dot(normal, from - canonical.origin) /
                                       glm::dot(normal, canonical.direction));
  return {beambench::accel::is_hit(exact) ? exact : t, scene.triangles[triangle].primitive};
}

/// The parameter that turns `with_exact_t` off.
inline beambench::ParameterInfo exact_t_parameter() {
  return beambench::flag_parameter(
      "exact_t", true, "t in double, from the plane of the triangle that the library found");
}

}  // namespace adapters
