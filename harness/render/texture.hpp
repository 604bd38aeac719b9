#pragma once
// Noise in space: what natural textures are made of.

#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench::render {

/// Gradient noise (Perlin, "An image synthesizer", SIGGRAPH 1985; the quintic of "Improving noise",
/// 2002) with a hash of our own: smooth, 0 at points of the integer lattice, about [-1, 1], the
/// same on every machine that rounds as IEEE 754 says.
double gradient_noise(const glm::dvec3& point);

/// The sum over octaves of noise of twice the frequency and half the size; about [-1, 1].
double fractal_noise(const glm::dvec3& point, int octaves);

/// The same of the noise's absolute value (Perlin 1985, "turbulence"); about [0, 1].
double turbulence(const glm::dvec3& point, int octaves);

/// Is a finish a texture, so that its color depends on the place?
bool is_texture(scenes::Finish finish);

/// Textures fill space, so that every scene may have them: veins and rings are measured in parts of
/// the scene.
class TextureSpace {
 public:
  explicit TextureSpace(const scenes::Scene& scene);

  /// The display color of a surface at a point of the scene: its own where its finish is not a
  /// texture.
  glm::dvec3 color_at(const scenes::Surface& surface, const glm::dvec3& point) const;

 private:
  glm::dvec3 middle_{0.0};
  double scale_ = 1.0;
};

}  // namespace beambench::render
