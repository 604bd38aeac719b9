#pragma once
// Noise in space: what natural textures are made of.

#include <glm/vec3.hpp>

namespace beambench::render {

/// Gradient noise (Perlin, "An image synthesizer", SIGGRAPH 1985; the quintic of "Improving noise",
/// 2002) with a hash of our own: smooth, 0 at points of the integer lattice, about [-1, 1], the
/// same on every machine that rounds as IEEE 754 says.
double gradient_noise(const glm::dvec3& point);

/// The sum over octaves of noise of twice the frequency and half the size; about [-1, 1].
double fractal_noise(const glm::dvec3& point, int octaves);

/// The same of the noise's absolute value (Perlin 1985, "turbulence"); about [0, 1].
double turbulence(const glm::dvec3& point, int octaves);

}  // namespace beambench::render
