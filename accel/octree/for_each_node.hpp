#pragma once
// Visits a node of an octree and all its descendants.

#include <cstdint>
#include <utility>
#include <vector>

namespace beambench::accel::octree {

/// Calls `visit(cursor)` for the node of `from` and for each of its descendants.
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
