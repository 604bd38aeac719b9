#pragma once
// The lamps of `habitacion`.

#include <glm/vec3.hpp>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// A lamp that hangs from the ceiling: `rim` is the middle of its shade's lower edge.
void add_hanging_lamp(SceneBuilder& builder, const glm::dvec3& rim, double ceiling);

/// A standing lamp with a pleated shade, 1.66 high.
void add_floor_lamp(SceneBuilder& builder, const glm::dvec3& place);

}  // namespace beambench::scenes::generators
