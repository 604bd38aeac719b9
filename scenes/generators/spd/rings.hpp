#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `rings:n`: a pyramid of objects of six interlocked pentagonal rings (SPD).
SceneInfo rings_scene();

}  // namespace beambench::scenes::generators
