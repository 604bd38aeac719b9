#pragma once
// What a transparent surface does to a direction.

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace beambench::render {

/// Where a ray goes behind a surface, by Snell's law, or nothing where all of it is reflected.
/// `incoming` and `normal` have unit length, the normal points to where the ray comes from; `ratio`
/// is the index of refraction before the surface over that behind it. The result has unit length
/// (Heckbert, "Writing a ray tracer", in Glassner, An Introduction to Ray Tracing, 1989).
inline std::optional<glm::dvec3> refracted(const glm::dvec3& incoming, const glm::dvec3& normal,
                                           double ratio) {
  const double cosine = -glm::dot(incoming, normal);
  const double behind = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
  if (behind < 0.0) return std::nullopt;
  return glm::normalize(ratio * incoming + (ratio * cosine - std::sqrt(behind)) * normal);
}

}  // namespace beambench::render
