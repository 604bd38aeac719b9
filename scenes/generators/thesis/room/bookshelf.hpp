#pragma once
// The bookshelf of `habitacion`.

#include <glm/mat4x4.hpp>

#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

inline constexpr glm::dvec3 kBookshelf = {1.24, 0.32, 2.12};  ///< width, depth, height

/// Five shelves of books between x = 0 and its width, its back at y = 0 against a wall, facing -y.
void add_bookshelf(SceneBuilder& builder, const glm::dmat4& place);

/// A closed book that lies at the origin, its spine to -y, of `size` (along the spine, across,
/// thick).
void add_lying_book(SceneBuilder& builder, const glm::dmat4& place, const glm::dvec3& size,
                    const glm::vec3& color);

}  // namespace beambench::scenes::generators
