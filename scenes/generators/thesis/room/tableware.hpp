#pragma once
// What stands on the tables of `habitacion`. Everything stands at z = 0 of its place.

#include <glm/mat4x4.hpp>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// A round teapot, 0.17 high, its spout to +x.
void add_china_teapot(SceneBuilder& builder, const glm::dmat4& place);
/// A cup with tea on its saucer, its handle to +x.
void add_cup(SceneBuilder& builder, const glm::dmat4& place);
/// A bowl of radius 0.17 with apples, oranges and a banana.
void add_fruit_bowl(SceneBuilder& builder, const glm::dmat4& place);
/// A vase with daisies, some 0.5 high.
void add_vase_of_flowers(SceneBuilder& builder, const glm::dmat4& place);

}  // namespace beambench::scenes::generators
