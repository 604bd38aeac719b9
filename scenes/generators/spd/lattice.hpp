#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `lattice:n`: n x n x n cells of spheres joined by cylinders (SPD).
SceneInfo lattice_scene();

}  // namespace beambench::scenes::generators
