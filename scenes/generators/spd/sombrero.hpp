#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `sombrero:n`: a round ripple over a square grid (SPD).
SceneInfo sombrero_scene();

}  // namespace beambench::scenes::generators
