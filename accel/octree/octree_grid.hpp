#pragma once
// The finest cells of an octree, by integer coordinates.

#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/overlap.hpp"

namespace beambench {

/// The root box of an octree cut into `cells` = 2^(max_level - 1) finest cells an axis. Everything
/// that needs a cell's boundary asks `plane`, so that neighbours read the same number.
struct OctreeGrid {
  glm::dvec3 lower{0.0};
  glm::dvec3 cell{1.0};  ///< size of a finest cell
  std::int32_t cells = 1;

  /// The coordinate of the boundary below cell `index` (0 ... cells) on an axis.
  double plane(int axis, std::int32_t index) const { return lower[axis] + cell[axis] * index; }

  /// The box of the cube of `size` finest cells an axis at `corner`.
  Box box(const glm::ivec3& corner, std::int32_t size) const {
    Box result{};
    for (int axis = 0; axis < 3; ++axis) {
      result.lower[axis] = plane(axis, corner[axis]);
      result.upper[axis] = plane(axis, corner[axis] + size);
    }
    return result;
  }
};

}  // namespace beambench
