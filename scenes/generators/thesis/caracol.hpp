#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `caracol`: the thesis's Caracol, the SPD's shell of n = 5 cut to 5,671 spheres.
SceneInfo caracol_scene();

}  // namespace beambench::scenes::generators
