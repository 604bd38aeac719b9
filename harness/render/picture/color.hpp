#pragma once
// Colors in linear light, their encoding for displays, and colors that represent numbers.

#include <algorithm>
#include <cmath>
#include <cstdint>

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

/// Returns the component that a display clips first.
inline float brightest(const glm::vec3& color) { return std::max({color.x, color.y, color.z}); }

/// Returns linear light for x in [0, 1] (clamped): from dark violet through teal to yellow.
/// Lightness rises evenly with x, so that everyone, including color-blind people, can see the order
/// of values, also in a black-and-white print. The colors are a path in Ottosson's Oklab ("A
/// perceptual color space for image processing", 2020), with the maximum chroma that sRGB allows
/// along the whole path.
glm::vec3 heat_color(float x);

/// Returns linear light that distinguishes ids: neighboring ids get very different hues.
glm::vec3 id_color(std::uint32_t id);

/// Converts lightness [0, 1], chroma and hue (radians) of Oklab to linear light; the result may be
/// outside [0, 1].
glm::vec3 linear_from_oklch(float lightness, float chroma, float hue);

}  // namespace beambench::render
