#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `mount:n`: a fractal mountain with four glass spheres before it (SPD).
SceneInfo mount_scene();

}  // namespace beambench::scenes::generators
