#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `misil`: the thesis's Misil, a missile.
SceneInfo misil_scene();

}  // namespace beambench::scenes::generators
