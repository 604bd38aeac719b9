#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `flamenco`: the thesis's Flamenco, a flamingo on one leg with empty space around it.
SceneInfo flamenco_scene();

}  // namespace beambench::scenes::generators
