#pragma once
// Tables and chairs of `habitacion`.

#include <glm/mat4x4.hpp>

#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

inline constexpr double kDiningTop = 0.75;  ///< height of the table's top
inline constexpr double kCoffeeTop = 0.43;

/// A turned leg from the floor up, open at both ends.
modelling::PolygonMesh turned_leg(double height, double radius, int sides);

/// A round table of radius 0.56 on a turned column with four feet.
void add_dining_table(SceneBuilder& builder, const glm::dmat4& place);
/// A long low table, 1.16 x 0.62, on turned legs, with a shelf below.
void add_coffee_table(SceneBuilder& builder, const glm::dmat4& place);
/// A chair with a bowed back and spindles; who sits on it looks to -y.
void add_chair(SceneBuilder& builder, const glm::dmat4& place);

}  // namespace beambench::scenes::generators
