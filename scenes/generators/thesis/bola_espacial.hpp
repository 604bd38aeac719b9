#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `bola-espacial`: the thesis's Bola espacial, a space ball that nearly fills its cube.
SceneInfo bola_espacial_scene();

}  // namespace beambench::scenes::generators
