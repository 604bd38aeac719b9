#pragma once
// Boxes.

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// The six faces of the box between two corners, in the order -x, +x, -y, +y, -z, +z.
PolygonMesh box(const glm::dvec3& lower, const glm::dvec3& upper);

/// The box without the face that looks to -z: for what stands on something.
PolygonMesh box_without_bottom(const glm::dvec3& lower, const glm::dvec3& upper);

/// The box with its edges cut off by `bevel` on both sides: 6 faces, 12 edges, 8 corner triangles.
/// 0 < bevel < half of every extent.
PolygonMesh bevelled_box(const glm::dvec3& lower, const glm::dvec3& upper, double bevel);

}  // namespace beambench::scenes::modelling
