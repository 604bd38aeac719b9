#pragma once
// The room of `habitacion`: its six sides, the window and the door.

#include <span>

#include "scenes/modelling/recessed.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// The room is [0, x] x [0, y] x [0, z].
inline constexpr glm::dvec3 kRoom = {5.2, 5.8, 2.75};

/// The window's opening in the wall y = kRoom.y, from (x, z) to (x, z).
inline constexpr modelling::Rectangle kWindow = {{1.15, 1.02}, {2.65, 2.27}};

/// Adds boards, walls, ceiling, skirting, cornice, window and door, all facing inward. No board is
/// laid where one of `covered` (rectangles of the floor) would hide all of it.
void add_room(SceneBuilder& builder, std::span<const modelling::Rectangle> covered);

}  // namespace beambench::scenes::generators
