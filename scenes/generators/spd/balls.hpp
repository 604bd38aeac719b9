#pragma once

#include <glm/vec3.hpp>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// Adds Haines's sphereflake (SPD, `balls`): a sphere that carries nine spheres of a third of its
/// radius, and so on `depth` times. There are (9^(depth + 1) - 1) / 8 spheres. Parents come before
/// children.
void add_sphereflake(SceneBuilder& builder, const glm::dvec3& center, double radius, int depth);

}  // namespace beambench::scenes::generators
