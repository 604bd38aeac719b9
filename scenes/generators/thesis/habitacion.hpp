#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `habitacion`: the thesis's Habitación, a furnished closed room seen from inside.
SceneInfo habitacion_scene();

}  // namespace beambench::scenes::generators
