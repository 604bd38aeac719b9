#pragma once
// Noise in space, the basis of natural textures.

#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench::render {

/// Returns gradient noise (Perlin, "An image synthesizer", SIGGRAPH 1985; the quintic of "Improving
/// noise", 2002) with our own hash: smooth, 0 at points of the integer lattice, roughly in [-1, 1],
/// the same on every machine with IEEE 754 rounding.
double gradient_noise(const glm::dvec3& point);

/// Returns the sum over octaves of noise with twice the frequency and half the amplitude; roughly
/// in [-1, 1].
double fractal_noise(const glm::dvec3& point, int octaves);

/// Returns the same sum for the absolute value of the noise (Perlin 1985, "turbulence"); roughly in
/// [0, 1].
double turbulence(const glm::dvec3& point, int octaves);

/// Returns whether a finish is a texture, so that its color depends on the place.
bool is_texture(scenes::Finish finish);

/// Textures fill space, so every scene may have them; veins and rings are scaled to the scene.
class TextureSpace {
 public:
  explicit TextureSpace(const scenes::Scene& scene);

  /// Returns the display color of a surface at a point of the scene: its own color unless its
  /// finish is a texture.
  glm::dvec3 color_at(const scenes::Surface& surface, const glm::dvec3& point) const;

 private:
  glm::dvec3 middle_{0.0};
  double scale_ = 1.0;
};

}  // namespace beambench::render
