#pragma once

#include <cstdint>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// Adds only the teapot, with the builder's current surface: 64 n^2 - 8 n smooth triangles.
void add_teapot(SceneBuilder& builder, std::int64_t n);

}  // namespace beambench::scenes::generators
