#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `tessellated-balls`: Escena 1 with triangles for spheres.
SceneInfo tessellated_balls_scene();

}  // namespace beambench::scenes::generators
