#pragma once
// Between linear light and the sRGB encoding of displays (IEC 61966-2-1).

#include <algorithm>
#include <cmath>

#include <glm/vec3.hpp>

namespace beambench::render {

/// Encodes linear light, clamped to [0, 1].
inline float srgb_from_linear(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
}

/// Decodes an sRGB value in [0, 1].
inline float linear_from_srgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

inline glm::vec3 srgb_from_linear(const glm::vec3& c) {
  return {srgb_from_linear(c.x), srgb_from_linear(c.y), srgb_from_linear(c.z)};
}
inline glm::vec3 linear_from_srgb(const glm::vec3& c) {
  return {linear_from_srgb(c.x), linear_from_srgb(c.y), linear_from_srgb(c.z)};
}

}  // namespace beambench::render
