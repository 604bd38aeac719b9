#pragma once
// The cat of `gato-bill`.

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// Adds a sitting cartoon cat, 2.2 high, its seat and feet on z = 0, facing -y: its fur, then
/// eyes, nose, tongue and whiskers, each without the polygons that are inside the head.
void add_cartoon_cat(SceneBuilder& builder);

}  // namespace beambench::scenes::generators
