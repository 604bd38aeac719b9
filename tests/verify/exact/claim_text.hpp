#pragma once
// Prints a ray, its scene, a claim and the exact decisions, with exact numbers.

#include <string>
#include <variant>

#include <fmt/format.h>

#include "scenes/scene.hpp"
#include "tests/verify/exact/acceptance.hpp"
#include "tests/verify/exact/claims.hpp"

namespace beambench::exact {

inline std::string text_of(const glm::vec3& v) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z);
}

inline std::string text_of(const scenes::Scene& scene, scenes::PrimitiveId id) {
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere: {
      const scenes::Sphere& sphere = scene.spheres[primitive.index];
      return fmt::format("sphere {} {:.9g}{}", text_of(sphere.center), sphere.radius,
                         sphere.inside_only ? " inside only" : "");
    }
    case scenes::PrimitiveKind::kCone: {
      const scenes::Cone& cone = scene.cones[primitive.index];
      return fmt::format("cone {} {:.9g} {} {:.9g}{}", text_of(cone.base), cone.base_radius,
                         text_of(cone.apex), cone.apex_radius,
                         cone.inside_only ? " inside only" : "");
    }
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  std::string text = "polygon";
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    text += " " + text_of(scene.vertices[scene.corners[polygon.first_corner + i]]);
  }
  return text;
}

/// Prints the ray and all crossings of its line, with their primitives.
inline std::string text_of(const scenes::Scene& scene, const Traced& traced) {
  const accel::Ray& ray = traced.ray.given;
  std::string text = fmt::format("  ray {} + t {}, t in [{:.9g}, {:.9g}]\n", text_of(ray.origin),
                                 text_of(ray.direction), ray.t_min, ray.t_max);
  const Acceptance strict(traced, kStrict);
  const Acceptance generous(traced, kGenerous);
  for (std::size_t i = 0; i < traced.crossings.size(); ++i) {
    const Crossing& crossing = traced.crossings[i];
    text += fmt::format("  crossing t = {:.17g}{}, primitive {}, {}\n",
                        traced.ray.t_of(crossing.at.rounded()),
                        traced.inside[i] ? "" : " not in the interval", crossing.primitive,
                        strict.is_graze(crossing)     ? "grazed"
                        : generous.is_graze(crossing) ? "possibly grazed"
                                                      : "clear");
  }
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    text += fmt::format("  primitive {}: {}\n", id, text_of(scene, id));
  }
  return text;
}

inline std::string text_of(const scenes::Scene& scene, const Traced& traced,
                           const ClosestClaim& claim) {
  return (claim ? fmt::format("  claim: primitive {} at t = {:.9g}\n", claim->primitive, claim->t)
                : std::string("  claim: miss\n")) +
         text_of(scene, traced);
}

inline std::string text_of(const scenes::Scene& scene, const Traced& traced, bool occluded) {
  return (occluded ? "  claim: occluded\n" : "  claim: not occluded\n") + text_of(scene, traced);
}

}  // namespace beambench::exact
