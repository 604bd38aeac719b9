#pragma once
// The house of `casa-de-campo`.

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// Adds the house: 10 wide (x from -5), 7 deep (y from 0, the front), the ridge 7.6 high; a porch
/// stands before its door on [-2, 2] x [-2, 0].
void add_country_house(SceneBuilder& builder);

}  // namespace beambench::scenes::generators
