#pragma once
// All nodes below a node of an octree.

#include <cstdint>
#include <utility>
#include <vector>

namespace beambench::accel::octree {

/// Calls `visit(cursor)` at each node below a place in an octree, and at that place itself.
template <class Cursor, class Visit>
void for_each_node(Cursor from, Visit visit) {
  std::vector<Cursor> open{std::move(from)};
  while (!open.empty()) {
    const Cursor place = open.back();
    open.pop_back();
    visit(place);
    if (place.is_leaf()) continue;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      Cursor child = place;
      child.enter(octant);
      open.push_back(child);
    }
  }
}

}  // namespace beambench::accel::octree
