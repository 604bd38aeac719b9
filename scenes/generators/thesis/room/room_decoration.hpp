#pragma once
// Pictures, clock and potted plant of `habitacion`.

#include <glm/mat4x4.hpp>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// Framed pictures hang in the plane z = 0 of `place`, their lower left outer corner at its origin.
/// This one, 0.62 x 0.62, shows Sierpinski's triangle, as `stetra` does in space.
void add_triangle_picture(SceneBuilder& builder, const glm::dmat4& place);
/// 0.8 x 0.6: a sailing boat under the sun.
void add_boat_picture(SceneBuilder& builder, const glm::dmat4& place);
/// A clock of radius 0.17 around the origin of `place`, at ten past ten.
void add_clock(SceneBuilder& builder, const glm::dmat4& place);
/// A pot with arching leaves, about 1.1 high.
void add_potted_plant(SceneBuilder& builder, const glm::dvec3& place);

}  // namespace beambench::scenes::generators
