#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `ajedrez`: the thesis's Ajedrez, a chess set on its board.
SceneInfo ajedrez_scene();

}  // namespace beambench::scenes::generators
