#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `soup`: triangles at random that share nothing.
SceneInfo soup_scene();

}  // namespace beambench::scenes::generators
