#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `bumpy:triangles`: a closed bumpy sphere of any number of triangles.
SceneInfo bumpy_scene();

}  // namespace beambench::scenes::generators
