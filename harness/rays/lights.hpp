#pragma once
// The colors of lights, and lights with an extent.

#include <vector>

#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench::rays {

/// Returns the colors of a scene's lights as they are shaded. Lights without a stated color are
/// white, with NFF's intensity: 1 / sqrt(number of lights) each.
std::vector<glm::dvec3> light_colors(const scenes::Scene& scene);

/// A luminous ball about each point light.
struct LightExtent {
  int points = 16;     ///< number of points of each light, at least 1
  double size = 0.05;  ///< diameter of the ball, in diagonals of the scene's box
};
inline constexpr int kMaxLightPoints = 1024;

/// Returns point lights in the ball about each light of a scene, light by light. All lights, and
/// all places that they illuminate, use the same points. These are spread evenly: directions by a
/// Fibonacci lattice (Gonzalez, "Measurement of areas on a sphere using Fibonacci and latitude-
/// longitude lattices", Mathematical Geosciences 42, 2010), distances by a Weyl sequence. Together,
/// the points are as bright as the light.
std::vector<scenes::Light> area_lights(const scenes::Scene& scene, const LightExtent& extent);

}  // namespace beambench::rays
