#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `maceta`: the thesis's Maceta, a potted plant spread over the whole volume.
SceneInfo maceta_scene();

}  // namespace beambench
