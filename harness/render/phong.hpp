#pragma once
// Highlights.

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/core/mirrored.hpp"

namespace beambench::render {

/// Phong's (CACM 18(6), 1975): how near the eye is to where a mirror would send the light. All
/// directions have unit length.
inline double phong(const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye,
                    double shine) {
  const double cosine = glm::dot(accel::mirrored(-to_light, normal), to_eye);
  return cosine > 0.0 ? std::pow(cosine, std::max(shine, 1.0)) : 0.0;
}

}  // namespace beambench::render
