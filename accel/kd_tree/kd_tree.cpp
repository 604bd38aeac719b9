#include "accel/kd_tree/kd_tree.hpp"

namespace beambench::accel::kd_tree {

scenes::Bounds lower_cell(const scenes::Bounds& cell, const KdNode& node) {
  scenes::Bounds part = cell;
  part.upper[static_cast<int>(node.axis())] = node.plane();
  return part;
}

scenes::Bounds upper_cell(const scenes::Bounds& cell, const KdNode& node) {
  scenes::Bounds part = cell;
  part.lower[static_cast<int>(node.axis())] = node.plane();
  return part;
}

KdPlace place_of(const KdTree& tree, std::uint32_t node) {
  KdPlace place{tree.root, 1};
  std::uint32_t at = 0;
  while (at != node) {
    const KdNode& parent = tree.nodes[at];
    const std::uint32_t lower = parent.children();
    const std::uint32_t upper = lower + 1;
    // The upper child's subtree comes after the lower one's.
    const bool is_below_upper = node == upper || (node > upper && !tree.nodes[upper].is_leaf() &&
                                                  node >= tree.nodes[upper].children());
    place.cell = is_below_upper ? upper_cell(place.cell, parent) : lower_cell(place.cell, parent);
    ++place.level;
    at = is_below_upper ? upper : lower;
  }
  return place;
}

}  // namespace beambench::accel::kd_tree
