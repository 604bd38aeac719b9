#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `escena1`: the thesis's Escena 1, spheres of different sizes spread evenly over a volume.
SceneInfo escena1_scene();

}  // namespace beambench::scenes::generators
