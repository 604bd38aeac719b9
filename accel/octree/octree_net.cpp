#include "accel/octree/octree_net.hpp"

namespace beambench::accel::octree {

OctreeNet::OctreeNet(const Octree& octree) {
  const auto nodes = octree.nodes();
  places_.resize(nodes.size());
  places_[0].neighbors.fill(kOutside);
  places_[0].size = static_cast<std::uint16_t>(octree.grid().cells.x);
  // Children follow their parent, so its links are known when theirs are made.
  for (std::size_t index = 0; index < nodes.size(); ++index) {
    const OctreeNode& node = nodes[index];
    if (node.is_leaf()) continue;
    const Place& parent = places_[index];
    const auto half = static_cast<std::uint16_t>(parent.size / 2);
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      Place& child = places_[node.first + octant];
      child.size = half;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t bit = 1U << axis;
        const bool upper = (octant & bit) != 0;
        const std::uint32_t mirrored = octant ^ bit;
        child.corner[axis] = static_cast<std::uint16_t>(parent.corner[axis] + (upper ? half : 0));
        // Behind the inner face lies a sibling. Behind the outer face lies a child of the parent's
        // neighbor, or that neighbor itself if it is a leaf.
        child.neighbors[2 * axis + (upper ? 0 : 1)] = node.first + mirrored;
        const std::size_t outer = 2 * axis + (upper ? 1 : 0);
        const std::uint32_t beyond = parent.neighbors[outer];
        child.neighbors[outer] =
            beyond == kOutside || nodes[beyond].is_leaf() ? beyond : nodes[beyond].first + mirrored;
      }
    }
  }
}

void OctreeNet::describe(Statistics& statistics) const {
  const std::size_t bytes = sizeof(*this) + places_.capacity() * sizeof(Place);
  statistics.bytes += bytes;
  statistics.more.emplace_back("net_bytes", static_cast<double>(bytes));
}

}  // namespace beambench::accel::octree
