#pragma once

#include <cstdint>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// The shell alone, in `steps` + 1 spheres less the first `left_out` at its tip.
void add_shell(SceneBuilder& builder, std::int64_t steps, std::int64_t left_out = 0);

}  // namespace beambench::scenes::generators
