#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `tetera`: the thesis's Tetera, the teapot's 992 triangles at 4 x 4 a patch on a box of 12.
SceneInfo tetera_scene();

}  // namespace beambench::scenes::generators
