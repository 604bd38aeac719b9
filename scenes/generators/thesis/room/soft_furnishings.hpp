#pragma once
// The rug and the curtains of `habitacion`.

#include "scenes/modelling/recessed.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// A woven rug over a rectangle of the floor, a quad a knot of its pattern, fringed left and right.
void add_rug(SceneBuilder& builder, const modelling::Rectangle& place);

/// Two curtains on a rod in the plane y = `y` before the window from `window.lower` to
/// `window.upper` (x, z), gathered to its sides.
void add_curtains(SceneBuilder& builder, const modelling::Rectangle& window, double y);

}  // namespace beambench::scenes::generators
