#pragma once
// Lights with an extent, as several point lights each.

#include <vector>

#include "scenes/scene.hpp"

namespace beambench::rays {

/// A luminous ball about each point light.
struct LightExtent {
  int points = 16;     ///< of each light, at least 1
  double size = 0.05;  ///< diameter of the ball, in diagonals of the scene's box
};
inline constexpr int kMaxLightPoints = 1024;

/// Returns point lights in the ball about each light of a scene, light by light: the same points
/// for all lights and all places that they illuminate. They are spread evenly: directions by a
/// Fibonacci lattice (Gonzalez, "Measurement of areas on a sphere using Fibonacci and latitude-
/// longitude lattices", Mathematical Geosciences 42, 2010), distances by a Weyl sequence. Together
/// they are as bright as the light, which the shader divides by the square root of the number of
/// lights.
std::vector<scenes::Light> area_lights(const scenes::Scene& scene, const LightExtent& extent);

}  // namespace beambench::rays
