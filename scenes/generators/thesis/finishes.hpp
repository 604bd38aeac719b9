#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `finishes`: a ball of each surface and texture of the thesis, on a floor of tiles.
SceneInfo finishes_scene();

}  // namespace beambench::scenes::generators
