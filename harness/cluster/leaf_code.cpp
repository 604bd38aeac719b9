#include "harness/cluster/leaf_code.hpp"

#include <bit>

#include "harness/cluster/bytes.hpp"

namespace beambench::cluster {

std::uint64_t leaf_code(const accel::octree::Octree& octree, const glm::ivec3& corner,
                        std::int32_t size) {
  std::uint64_t code = 1;
  for (std::int32_t half = octree.grid().cells.x / 2; half >= size; half /= 2) {
    for (const int axis : {2, 1, 0}) code = 2 * code + ((corner[axis] & half) != 0 ? 1 : 0);
  }
  return code;
}

accel::octree::OctreeCursor find_leaf(const accel::octree::Octree& octree, std::uint64_t code) {
  accel::octree::OctreeCursor cursor(octree);
  for (auto shift = static_cast<int>(std::bit_width(code)) - 1;
       shift > 0 && !cursor.node().is_leaf();) {
    shift -= 3;
    if (shift < 0) break;
    const std::uint64_t octant = code >> static_cast<unsigned>(shift);
    glm::ivec3 corner = cursor.corner();
    for (int axis = 0; axis < 3; ++axis) {
      if (((octant >> static_cast<unsigned>(axis)) & 1) != 0) corner[axis] += cursor.size() / 2;
    }
    cursor.enter_child(corner);
  }
  if (!cursor.node().is_leaf() || leaf_code(octree, cursor.corner(), cursor.size()) != code) {
    throw ProtocolError("a beam names a leaf that is not in this process's octree");
  }
  return cursor;
}

}  // namespace beambench::cluster
