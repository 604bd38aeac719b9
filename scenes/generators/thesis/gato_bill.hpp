#pragma once

#include "scenes/catalogue.hpp"

namespace beambench::scenes::generators {

/// `gato-bill`: the thesis's Gato-Bill, a cartoon cat on one large floor polygon, letters behind.
SceneInfo gato_bill_scene();

}  // namespace beambench::scenes::generators
