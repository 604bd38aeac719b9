#pragma once
// Divides a scene among processes.

#include <cstdint>
#include <utility>
#include <vector>

#include "accel/core/cell_grid.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/octree/octree.hpp"
#include "harness/thesis/cluster/split/scene_division.hpp"
#include "harness/thesis/cluster/transport.hpp"
#include "scenes/scene.hpp"

namespace beambench::cluster {

/// The cells of one level, and for each primitive the cells into which its box reaches.
class SceneCells {
 public:
  /// Uses cells of `level`, at most 7 and not deeper than the octree of `options`.
  SceneCells(const scenes::Scene& scene, const accel::octree::OctreeOptions& options, int level);

  const LevelCells& cells() const { return cells_; }
  /// Returns the number of primitives in each cell.
  const std::vector<std::uint32_t>& primitives() const { return primitives_; }
  /// Must not be called after `forget_primitives`.
  const accel::CellRange& range(scenes::PrimitiveId id) const { return ranges_[id]; }
  /// Frees the memory that grows with the scene.
  void forget_primitives() { ranges_ = {}; }

  bool is_empty(std::uint32_t cell) const { return primitives_[cell] == 0; }
  /// Returns whether all cells of a node are empty; the node begins at `first` and has `size` cells
  /// along each axis.
  bool is_empty(const glm::ivec3& first, std::int32_t size) const;

 private:
  LevelCells cells_;
  std::vector<std::uint32_t> primitives_;
  std::vector<accel::CellRange> ranges_;  ///< by primitive
};

/// The cells of one level of an octree, distributed among processes. All processes compute the same
/// split.
class SceneSplit {
 public:
  SceneSplit(SceneCells contents, std::vector<std::uint16_t> owners)
      : contents_(std::move(contents)), owners_(std::move(owners)) {}

  const LevelCells& cells() const { return contents_.cells(); }
  const SceneCells& contents() const { return contents_; }
  ProcessId owner(std::uint32_t cell) const { return owners_[cell]; }
  /// Returns whether the cell belongs to another process. Beams and rays pass through empty cells
  /// in any process.
  bool is_foreign(std::uint32_t cell, ProcessId process) const {
    return owner(cell) != process && !contents_.is_empty(cell);
  }

  /// Returns whether the primitive's box reaches into a cell of the process. Must not be called
  /// after `forget_primitives`.
  bool reaches(ProcessId process, scenes::PrimitiveId id) const;
  void forget_primitives() { contents_.forget_primitives(); }

 private:
  SceneCells contents_;
  std::vector<std::uint16_t> owners_;  ///< by cell
};

/// Divides a scene; if the division needs costs, estimates them by tracing `rays`.
SceneSplit split_scene(const scenes::Scene& scene, const accel::octree::OctreeOptions& options,
                       const accel::PrimaryRays& rays, int level, SceneDivision division,
                       int processes);

/// Returns the part of an octree that a process builds. All nonempty cells exist in it; those of
/// other processes are leaves.
accel::octree::OctreePart own_cells(const SceneSplit& split, ProcessId process);

/// The part of a scene that one process keeps.
struct ScenePart {
  /// Its primitives, in order; bounds, cameras, surfaces and lights are those of the whole scene.
  scenes::Scene scene;
  /// The primitives' ids in the whole scene, ascending.
  std::vector<scenes::PrimitiveId> global;
};

ScenePart part_of(const scenes::Scene& scene, const SceneSplit& split, ProcessId process);

}  // namespace beambench::cluster
