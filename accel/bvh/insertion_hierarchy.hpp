#pragma once
// Goldsmith and Salmon's hierarchy of bounding volumes.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "scenes/bounds.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel::bvh {

/// One entry of a hierarchy: a bounding volume, or an object with its own box.
struct HierarchyEntry {
  scenes::Bounds box;
  std::uint32_t end;              ///< index just past this entry's subtree
  scenes::PrimitiveId primitive;  ///< kNoPrimitive for a volume

  bool is_volume() const { return primitive == scenes::kNoPrimitive; }
};

/// A hierarchy in preorder: the children of an entry follow it, and the next sibling of a child is
/// at the child's `end`. The first entry is the root, a volume; an empty hierarchy has no entries.
struct InsertionHierarchy {
  std::vector<HierarchyEntry> entries;
  std::uint64_t volumes = 0;
  std::uint64_t depth = 0;          ///< volumes on the longest path down
  std::uint64_t widest = 0;         ///< maximum number of children of a volume
  double cost = 0.0;                ///< see hierarchy_cost
  std::uint64_t boxes_weighed = 0;  ///< unions of boxes whose area the build computed
};

/// Returns the expected number of tests for a ray that meets the root: the sum over volumes of k A
/// / A_root, where k is the number of direct children and A the surface area (Goldsmith and Salmon
/// 1987; thesis, section 4.3).
double hierarchy_cost(std::span<const HierarchyEntry> entries);

/// Where an object may be placed on its path down; the path always enters the child that grows
/// least.
enum class Insertion {
  /// Wherever on the path it raises the cost least (Goldsmith and Salmon, "Automatic Creation of
  /// Object Hierarchies for Ray Tracing", 1987). With k children, area A, and area A' including the
  /// object, three choices are compared at every volume:
  /// - the object becomes one more child of the volume: (k + 1) A' - k A;
  /// - the object and a child of the volume become the two children of a new volume in the child's
  ///   place: k (A' - A) for the volume and 2 A'' for the new one;
  /// - the object goes further down: k (A' - A) plus the cost there.
  kEverywhere,
  /// Only at the end of the path, as described in the thesis (section 4.3). A terminal node is an
  /// object with its box. The new object either becomes another child of the terminal node's
  /// volume, or both become the children of a new volume, whichever of the first two choices above
  /// is cheaper.
  kTerminal
};

/// Inserts the objects one by one in the given order, without moving any object afterward.
/// `boxes[i]` is the box of primitive i.
InsertionHierarchy build_by_insertion(std::span<const scenes::Bounds> boxes,
                                      std::span<const scenes::PrimitiveId> order,
                                      Insertion insertion);

}  // namespace beambench::accel::bvh
