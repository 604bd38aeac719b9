#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `gears:n`: n x n x n meshing gears over a mirror (SPD).
SceneInfo gears_scene();

}  // namespace beambench
