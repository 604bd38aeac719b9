#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `tree:n`: a tree of n generations of branches on a field (SPD).
SceneInfo tree_scene();

}  // namespace beambench::scenes::generators
