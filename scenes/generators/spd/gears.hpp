#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `gears:n`: n x n x n meshing gears over a mirror (SPD).
SceneInfo gears_scene();

}  // namespace beambench::scenes::generators
