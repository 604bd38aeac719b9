#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `finishes`: a ball of each surface and texture of the thesis, on a floor of tiles.
SceneInfo finishes_scene();

}  // namespace beambench
