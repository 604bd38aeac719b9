#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `tetra:n`: Haines's recursive tetrahedra (SPD), 4^n triangles.
SceneInfo tetra_scene();
/// `stetra`: the thesis's Stetra, tetra with n = 4.
SceneInfo stetra_scene();

}  // namespace beambench::scenes::generators
