#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `torre-eiffel`: the thesis's Torre Eiffel, a lattice tower with empty space around it.
SceneInfo torre_eiffel_scene();

}  // namespace beambench::scenes::generators
