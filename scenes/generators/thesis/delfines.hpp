#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `delfines`: the thesis's Delfines, three dolphins of 564 triangles each.
SceneInfo delfines_scene();

}  // namespace beambench::scenes::generators
