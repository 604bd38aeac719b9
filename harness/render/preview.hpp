#pragma once
// A quick, friendly look at a surface.

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// Linear light from a hit: Lambert and Phong under the scene's lights and a headlight at the eye,
/// without shadows. The headlight leaves no side of a thing black. The scene's colors are display
/// values, as they were in 1987; they are decoded to linear light first.
glm::vec3 preview_color(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit);

/// Linear light of a miss.
glm::vec3 background_color(const scenes::Scene& scene);

}  // namespace beambench::render
