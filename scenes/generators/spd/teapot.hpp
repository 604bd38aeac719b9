#pragma once

#include <cstdint>

#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// `teapot:n`: Newell's teapot, each patch cut into n x n quads, on a board (SPD).
SceneInfo teapot_scene();

/// The pot alone, with the builder's current surface: 64 n^2 - 8 n smooth triangles.
void add_teapot(SceneBuilder& builder, std::int64_t n);

}  // namespace beambench::scenes::generators
