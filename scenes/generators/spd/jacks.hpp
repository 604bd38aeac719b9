#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `jacks:n`: n generations of jacks, eight smaller ones around each (SPD).
SceneInfo jacks_scene();

}  // namespace beambench::scenes::generators
