#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `ajedrez`: the thesis's Ajedrez, a chess set on its board.
SceneInfo ajedrez_scene();

}  // namespace beambench
