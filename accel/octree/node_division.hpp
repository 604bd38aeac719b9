#pragma once
// How a node of an octree is divided: the rules that all builders share.

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

/// Where a node lies.
struct OctreeCell {
  glm::ivec3 corner{0};
  glm::ivec3 size{1};  ///< in finest cells
  int level = 1;       ///< the root being level 1

  /// Child number x + 2 y + 4 z.
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

/// Decides whether a node is divided, by which planes, and which children refer to a primitive: a
/// function of the scene, the options and the node alone, whoever asks and when. Several threads
/// may ask at once. Scene and options must outlive it.
class NodeDivision {
 public:
  NodeDivision(const scenes::Scene& scene, const OctreeOptions& options);

  const CellGrid& grid() const { return grid_; }
  OctreeCell root() const { return {glm::ivec3(0), grid_.cells, 1}; }

  /// Is a node with that many primitives divided?
  bool divides(const OctreeCell& cell, std::size_t primitives) const {
    return primitives > options_->max_objects && can_divide(cell);
  }
  /// May it be? Not at `max_level`, nor where it is one finest cell thin.
  bool can_divide(const OctreeCell& cell) const {
    return cell.level < options_->max_level && cell.size.x > 1 && cell.size.y > 1 &&
           cell.size.z > 1;
  }
  /// The planes between the children, as finest cells.
  glm::ivec3 split(const OctreeCell& cell, std::span<const scenes::PrimitiveId> primitives) const;

  /// Writes the children's lists, one after the other, each in increasing id; returns where each
  /// ends. `octants` is scratch.
  std::array<std::size_t, 8> distribute(const OctreeCell& cell, const glm::ivec3& split,
                                        std::span<const scenes::PrimitiveId> primitives,
                                        std::vector<std::uint8_t>& octants,
                                        std::vector<scenes::PrimitiveId>& lists) const;

  /// An estimate for the octree that is divided no deeper than `level`.
  ExpectedReferences expected_references(int level, Random& random) const;
  /// Will the octree that is divided no deeper than `level` refer to more than `max_references`
  /// primitives, in its leaves or, if `of_lists`, in all nodes but the root?
  bool will_exceed(int level, bool of_lists) const;
  /// The same before it is built, from a small part of many primitives where planes are fixed.
  /// Throws what `fail_too_many_references` throws.
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
  std::vector<CellRange> ranges_;  ///< in finest cells, by primitive
  std::vector<bool> repeats_;      ///< has the surface of the primitive before it
};

}  // namespace beambench::accel::octree
