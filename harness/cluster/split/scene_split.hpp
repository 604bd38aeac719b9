#pragma once
// The division of a scene among processes.

#include <cstdint>
#include <vector>

#include "accel/core/cell_grid.hpp"
#include "accel/octree/octree.hpp"
#include "harness/cluster/transport.hpp"
#include "scenes/scene.hpp"

namespace beambench::cluster {

/// The cells of one level of an octree, distributed in Morton order, so that a process's cells are
/// neighbors, with about as many primitives for each process. All processes compute the same split.
class SceneSplit {
 public:
  /// Cells of `level`, at most 7 and not deeper than the octree of `options`.
  SceneSplit(const scenes::Scene& scene, const accel::octree::OctreeOptions& options, int level,
             int processes);

  int level() const { return level_; }
  /// Along each axis.
  std::int32_t cells() const { return cells_; }
  std::uint32_t index(const glm::ivec3& cell) const {
    return static_cast<std::uint32_t>((cell.z * cells_ + cell.y) * cells_ + cell.x);
  }
  glm::ivec3 cell(std::uint32_t index) const {
    const auto i = static_cast<std::int32_t>(index);
    return {i % cells_, i / cells_ % cells_, i / (cells_ * cells_)};
  }
  std::uint32_t cell_count() const { return static_cast<std::uint32_t>(owners_.size()); }
  ProcessId owner(std::uint32_t index) const { return owners_[index]; }

  /// Does the primitive's box reach into a cell of the process? Not after `forget_primitives`.
  bool reaches(ProcessId process, scenes::PrimitiveId id) const;
  /// Frees the memory that grows with the scene.
  void forget_primitives() { ranges_ = {}; }

 private:
  int level_;
  std::int32_t cells_;
  std::vector<std::uint16_t> owners_;     ///< by cell
  std::vector<accel::CellRange> ranges_;  ///< by primitive
};

/// The part of a scene that one process keeps.
struct ScenePart {
  /// Its primitives, in their order; bounds, cameras, surfaces and lights are those of the whole.
  scenes::Scene scene;
  /// The ids that they have in the whole scene, ascending.
  std::vector<scenes::PrimitiveId> global;
};

ScenePart part_of(const scenes::Scene& scene, const SceneSplit& split, ProcessId process);

}  // namespace beambench::cluster
