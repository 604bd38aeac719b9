#pragma once
// Descends from a node of an octree to the leaf that contains the ray.

#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/core/cell_ray.hpp"

namespace beambench::accel::octree {

/// Descends to the leaf that contains the ray at parameter t (a point on a boundary belongs to the
/// side that the ray moves to). Returns the number of levels descended.
template <class Cursor>
[[gnu::always_inline]] inline int descend_to_leaf(Cursor& cursor, const CellRay& ray, double t) {
  int levels = 0;
  for (; !cursor.is_leaf(); ++levels) {
    const glm::ivec3 split = cursor.split();
    std::uint32_t octant = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (ray.above(axis, split[axis], t)) octant |= 1U << static_cast<unsigned>(axis);
    }
    cursor.enter(octant);
  }
  return levels;
}

}  // namespace beambench::accel::octree
