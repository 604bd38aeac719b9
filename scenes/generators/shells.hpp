#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `shells:n`: Pickover's seashell of nearly concentric spheres (SPD).
SceneInfo shells_scene();

}  // namespace beambench
