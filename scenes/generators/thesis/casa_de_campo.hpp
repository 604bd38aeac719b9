#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `casa-de-campo`: the thesis's Casa de Campo, a country house in its garden.
SceneInfo casa_de_campo_scene();

}  // namespace beambench::scenes::generators
