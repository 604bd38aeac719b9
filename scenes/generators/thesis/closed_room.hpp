#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `closed-room`: a hall of columns seen from inside; every ray hits.
SceneInfo closed_room_scene();

}  // namespace beambench::scenes::generators
