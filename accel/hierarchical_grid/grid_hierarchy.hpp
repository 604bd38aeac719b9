#pragma once
// Grids in the voxels of grids.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell.hpp"
#include "accel/core/cell_grid.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/statistics.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "accel/hierarchical_grid/hierarchical_grid_options.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::hierarchical_grid {

/// A voxel in four bytes: empty, the position of its references, or the number of the grid in it.
class Voxel {
 public:
  Voxel() = default;
  static Voxel with_references(std::uint32_t first) { return Voxel(first); }
  static Voxel with_grid(std::uint32_t grid) { return Voxel(kGrid | grid); }

  bool is_empty() const { return word_ == 0; }
  bool is_divided() const { return (word_ & kGrid) != 0; }
  std::uint32_t grid() const { return word_ & ~kGrid; }  ///< only for a divided voxel
  /// For a voxel with references: the position of their count, which precedes them. Never 0.
  std::uint32_t first() const { return word_; }

 private:
  explicit Voxel(std::uint32_t word) : word_(word) {}

  static constexpr std::uint32_t kGrid = std::uint32_t{1} << 31U;
  std::uint32_t word_ = 0;
};

/// One of the grids: the scene's grid, or a grid in a voxel of another one.
struct NestedGrid {
  grid::WalkGrid walk;
  std::uint32_t first_voxel;  ///< its voxels are consecutive, x fastest
  std::int32_t level;         ///< the scene's grid has level 1

  const CellGrid& place() const { return walk.cells; }
};

/// Jevans and Wyvill, "Adaptive voxel subdivision for ray tracing" (Graphics Interface 1989): a
/// grid over the scene, and in each voxel that refers to more than `max_objects` primitives another
/// grid, down to `max_level`. An undivided voxel refers to each primitive whose surface (or box)
/// overlaps it, closed and widened by `overlap_tolerance`, in order of id.
class GridHierarchy {
 public:
  /// Throws an InputError that names `max_voxels` if the top grid has more voxels, or
  /// `max_references` if its voxels have more references. If the grids in the voxels of a grid
  /// would bring the total above `max_voxels`, none of them is made. A voxel whose grid would bring
  /// the total above `max_references` is not divided; with `divide=always`, this is an InputError.
  GridHierarchy(const scenes::Scene& scene, const HierarchicalGridOptions& options);

  std::span<const NestedGrid> grids() const { return grids_; }
  const NestedGrid& top() const { return grids_.front(); }
  Voxel voxel(std::size_t index) const { return voxels_[index]; }
  const Voxel* voxels() const { return voxels_.data(); }
  /// Returns the references of an undivided voxel.
  std::span<const scenes::PrimitiveId> references(Voxel voxel) const {
    const scenes::PrimitiveId* list = references_.data() + voxel.first();
    return {list + 1, *list};
  }

  Statistics statistics() const;
  /// Returns the undivided voxels that hold references.
  std::vector<Cell> occupied_cells() const;

 private:
  friend class GridHierarchyBuilder;

  scenes::Bounds scene_bounds_;
  std::vector<NestedGrid> grids_;  ///< the scene's grid first
  std::vector<Voxel> voxels_;
  /// Lists preceded by their lengths; all empty voxels use the first list.
  std::vector<scenes::PrimitiveId> references_{0};
};

}  // namespace beambench::accel::hierarchical_grid
