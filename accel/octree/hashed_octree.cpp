#include "accel/octree/hashed_octree.hpp"

#include <utility>

namespace beambench::accel::octree {

HashedOctree::HashedOctree(Octree octree)
    : octree_(std::move(octree)),
      // At most half of the slots are occupied, so that collisions are rare.
      mask_(std::bit_ceil(2 * octree_.nodes().size()) - 1),
      shift_(64 - std::countr_one(mask_)),
      names_(mask_ + 1),
      numbers_(mask_ + 1) {
  std::vector<std::uint64_t> name_of(octree_.nodes().size());
  name_of[0] = kRootName;
  for (std::uint32_t number = 0; number < name_of.size(); ++number) {
    insert(number, name_of[number]);
    const OctreeNode& node = octree_.nodes()[number];
    if (node.is_leaf()) continue;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      name_of[node.first + octant] = 8 * name_of[number] + octant;
    }
  }
}

void HashedOctree::insert(std::uint32_t number, std::uint64_t name) {
  std::size_t slot = slot_of(name);
  while (names_[slot] != 0) slot = (slot + 1) & mask_;
  names_[slot] = name;
  numbers_[slot] = number;
}

Statistics HashedOctree::statistics() const {
  Statistics statistics = octree_.statistics();
  statistics.bytes +=
      names_.capacity() * sizeof(std::uint64_t) + numbers_.capacity() * sizeof(std::uint32_t);
  return statistics;
}

}  // namespace beambench::accel::octree
