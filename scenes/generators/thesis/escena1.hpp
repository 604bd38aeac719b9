#pragma once
// The balls of Escena 1, used both as spheres and as triangle meshes.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

struct Ball {
  glm::dvec3 center;
  double radius;
};

/// Returns balls of random sizes in the cube [-10, 10]^3, spread evenly by best-candidate sampling
/// (Mitchell 1991): each ball gets the roomiest of several random positions and shrinks if it does
/// not fit.
std::vector<Ball> scattered_balls(std::int64_t count, std::uint64_t seed);

/// Adds the camera, background and lights of these scenes.
void light_balls(SceneBuilder& builder);

/// Returns the surface of one of `count` balls: six colors, one after another.
Surface surface_of_ball(std::size_t number, std::size_t count);

}  // namespace beambench::scenes::generators
