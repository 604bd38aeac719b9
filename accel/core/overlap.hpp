#pragma once
// Box-primitive overlap: whether a primitive's surface overlaps a closed box.

#include <array>

#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench::accel {

/// A closed axis-aligned box in double, such as a cell of an octree or a grid.
struct Box {
  glm::dvec3 lower;
  glm::dvec3 upper;
};

/// Returns whether the surface comes within `tolerance` of the box. Where noted, the test is
/// conservative: it may return true for surfaces slightly farther away, but never returns false for
/// a surface within the tolerance. The box is solid and the primitive hollow: a box entirely inside
/// a sphere does not overlap it.
bool surface_overlaps(const scenes::Scene& scene, scenes::PrimitiveId id, const Box& box,
                      double tolerance);

/// Returns whether two primitives have the same surface, number for number, and so overlap the same
/// boxes. False for the same surface in another form, such as a polygon listed from another corner.
bool same_surface(const scenes::Scene& scene, scenes::PrimitiveId a, scenes::PrimitiveId b);

/// Tests a sphere; exact, by interval evaluation of |x - c|^2 - r^2 over the box (Ratschek and
/// Rokne, "Test for intersection between box and sphere", 1994; Arvo, Graphics Gems, 1990).
bool sphere_overlaps(const scenes::Sphere& sphere, const Box& box, double tolerance);

/// Tests a polygon; exact except for the widening at corners. The polygon's corners are first
/// tested against the 6 face, 12 edge and 8 corner planes of the box (Voorhies, Graphics Gems III,
/// 1992; as outcodes: Green and Hatch, Graphics Gems V, 1995); if this does not decide, the
/// triangles of the polygon's surface are tested, so that concave polygons need no special case.
bool polygon_overlaps(const scenes::Scene& scene, const scenes::Polygon& polygon, const Box& box,
                      double tolerance);

/// Tests a triangle; exact except for the widening at corners, by the 13 separating axes of box and
/// triangle (Akenine-Möller, "Fast 3D triangle-box overlap testing", 2001).
bool triangle_overlaps(const std::array<glm::dvec3, 3>& corners, const Box& box, double tolerance);

/// Tests a cone; conservative: against the box of the end discs, the planes of the ends, the
/// distance to the axis and, for boxes inside, the corners against the solid cone.
bool cone_overlaps(const scenes::Cone& cone, const Box& box, double tolerance);

}  // namespace beambench::accel
