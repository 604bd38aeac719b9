#pragma once
// From a node of an octree down to the leaf that a ray is in.

#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/core/cell_ray.hpp"

namespace beambench::accel::octree {

/// Goes down to the leaf that the ray is in at parameter t (a point on a boundary belongs to the
/// side the ray is going to). Returns the number of levels descended.
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
