#pragma once
// From a number to a color.

#include <cstdint>

#include <glm/vec3.hpp>

namespace beambench::render {

/// Linear light for x in [0, 1] (clamped): from dark violet over teal to yellow. Lightness rises
/// evenly with x, so that the order of values can be seen by everyone, the color-blind included,
/// and survives a black-and-white print. A path in Ottosson's Oklab ("A perceptual color space for
/// image processing", 2020), with as much chroma as sRGB holds all along it.
glm::vec3 heat_color(float x);

/// Linear light that tells ids apart: neighboring ids get hues far from each other.
glm::vec3 id_color(std::uint32_t id);

/// Linear light from lightness [0, 1], chroma and hue (radians) of Oklab; may leave [0, 1].
glm::vec3 linear_from_oklch(float lightness, float chroma, float hue);

}  // namespace beambench::render
