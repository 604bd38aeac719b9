#pragma once
// Leaves by a number that means the same in every process.

#include <cstdint>

#include "accel/octree/octree_cursor.hpp"

namespace beambench::cluster {

/// The locational code of a node (thesis, section 6.2.2, "some code"; Gargantini 1982): the octants
/// on the way from the root, three bits each, behind a leading 1.
std::uint64_t leaf_code(const accel::octree::Octree& octree, const glm::ivec3& corner,
                        std::int32_t size);

/// The leaf of that code. Throws ProtocolError where the octree has none.
accel::octree::OctreeCursor find_leaf(const accel::octree::Octree& octree, std::uint64_t code);

}  // namespace beambench::cluster
