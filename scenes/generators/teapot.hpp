#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `teapot:n`: Newell's teapot, each patch cut into n x n quads, on a board (SPD).
SceneInfo teapot_scene();

}  // namespace beambench
