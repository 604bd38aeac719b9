#pragma once
// What one sees through the window of `habitacion`.

#include <glm/mat4x4.hpp>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// Closes the rectangle from (0, 0) to `size` in the plane z = 0 of `place` with a landscape: sky,
/// far hills and a meadow, side by side in that plane.
void add_window_view(SceneBuilder& builder, const glm::dmat4& place, const glm::dvec2& size);

}  // namespace beambench::scenes::generators
