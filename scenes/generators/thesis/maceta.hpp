#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `maceta`: the thesis's Maceta, a potted plant spread over the whole volume.
SceneInfo maceta_scene();

}  // namespace beambench::scenes::generators
