#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `balls:n`: Haines's sphereflake of depth n over a floor (SPD).
SceneInfo balls_scene();

}  // namespace beambench::scenes::generators
