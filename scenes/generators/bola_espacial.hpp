#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `bola-espacial`: the thesis's Bola espacial, a space ball that fills its volume evenly.
SceneInfo bola_espacial_scene();

}  // namespace beambench
