#pragma once
// The rules for dividing a node of an octree, shared by all builders.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "accel/core/expected_references.hpp"
#include "accel/octree/octree.hpp"
#include "scenes/base/random.hpp"
#include "scenes/primitive.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::octree {

/// The place of a node.
struct OctreeCell {
  glm::ivec3 corner{0};
  glm::ivec3 size{1};  ///< number of finest cells
  int level = 1;       ///< the root has level 1

  /// Returns the place of the child with the number x + 2 y + 4 z.
  OctreeCell child(const glm::ivec3& split, std::uint32_t octant) const {
    OctreeCell result{corner, split - corner, level + 1};
    for (int axis = 0; axis < 3; ++axis) {
      if ((octant >> static_cast<unsigned>(axis) & 1U) == 0) continue;
      result.corner[axis] = split[axis];
      result.size[axis] = corner[axis] + size[axis] - split[axis];
    }
    return result;
  }
};

/// Decides whether and by which planes a node is divided, and which children refer to a primitive.
/// The decisions depend only on the scene, the options and the node. Thread-safe. Scene and options
/// must outlive this object.
class NodeDivision {
 public:
  NodeDivision(const scenes::Scene& scene, const OctreeOptions& options);

  const CellGrid& grid() const { return grid_; }
  OctreeCell root() const { return {glm::ivec3(0), grid_.cells, 1}; }

  /// Returns whether a node with this many primitives is divided.
  bool divides(const OctreeCell& cell, std::size_t primitives) const {
    return primitives > options_->max_objects && can_divide(cell);
  }
  /// Returns whether a node may be divided: it is above `max_level` and more than one finest cell
  /// thick along each axis.
  bool can_divide(const OctreeCell& cell) const {
    return cell.level < options_->max_level && cell.size.x > 1 && cell.size.y > 1 &&
           cell.size.z > 1;
  }
  /// Returns the planes between the children, as finest cells.
  glm::ivec3 split(const OctreeCell& cell, std::span<const scenes::PrimitiveId> primitives) const;

  /// Writes the children's lists one after the other, each ordered by id, and returns the end of
  /// each list. `octants` is scratch memory.
  std::array<std::size_t, 8> distribute(const OctreeCell& cell, const glm::ivec3& split,
                                        std::span<const scenes::PrimitiveId> primitives,
                                        std::vector<std::uint8_t>& octants,
                                        std::vector<scenes::PrimitiveId>& lists) const;

  /// Estimates the references of the octree divided no deeper than `level`.
  ExpectedReferences expected_references(int level, Random& random) const;
  /// Predicts whether the octree divided no deeper than `level` will refer to more than
  /// `max_references` primitives, in its leaves or, if `of_lists`, in all nodes except the root.
  bool will_exceed(int level, bool of_lists) const;
  /// If planes are fixed, predicts the same before the octree is built, from a small sample if
  /// there are many primitives. Throws like `fail_too_many_references`.
  void require_few_references(int level, bool of_lists) const;

  /// Throws the InputError that names `max_references`.
  [[noreturn]] void fail_too_many_references() const;

 private:
  std::uint8_t overlapped_octants(const OctreeCell& cell, const glm::ivec3& split,
                                  scenes::PrimitiveId id) const;
  std::vector<scenes::PrimitiveId> all() const;
  auto estimate_of(std::vector<scenes::PrimitiveId> primitives, int level) const;

  const scenes::Scene* scene_;
  const OctreeOptions* options_;
  double tolerance_;
  CellGrid grid_;
  std::vector<CellRange> ranges_;  ///< finest cells of each primitive
  std::vector<bool> repeats_;      ///< whether a primitive has the surface of the preceding one
};

}  // namespace beambench::accel::octree
