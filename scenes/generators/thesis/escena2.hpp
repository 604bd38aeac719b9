#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `escena2`: the thesis's Escena 2, a tiny sphereflake in the middle of a huge volume.
SceneInfo escena2_scene();

}  // namespace beambench::scenes::generators
