#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `mount:n`: a fractal mountain with four glass spheres before it (SPD).
SceneInfo mount_scene();

}  // namespace beambench
