#pragma once

#include "scenes/catalogue.hpp"

namespace beambench {

/// `casa-de-campo`: the thesis's Casa de Campo, a country house in its garden.
SceneInfo casa_de_campo_scene();

}  // namespace beambench
