#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `sombrero:n`: a round ripple over a square grid (SPD).
SceneInfo sombrero_scene();

}  // namespace beambench
