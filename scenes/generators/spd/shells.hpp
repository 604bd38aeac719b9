#pragma once

#include <cstdint>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// Adds only the shell: `steps` + 1 spheres, without the first `left_out` spheres at its tip.
void add_shell(SceneBuilder& builder, std::int64_t steps, std::int64_t left_out = 0);

}  // namespace beambench::scenes::generators
