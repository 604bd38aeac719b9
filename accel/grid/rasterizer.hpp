#pragma once
// Finds the voxels that primitives overlap.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/grid/assign.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::grid {

/// Finds the closed voxels, widened by `overlap_tolerance`, that a primitive overlaps. `grid` may
/// cover only part of the scene.
class Rasterizer {
 public:
  /// Scene and grid must outlive this object.
  Rasterizer(const scenes::Scene& scene, const CellGrid& grid, Assign assign)
      : scene_(&scene), grid_(&grid), assign_(assign), tolerance_(overlap_tolerance(scene)) {}

  /// Calls `emit(voxel)` with the index of each voxel until `emit` returns false; returns whether
  /// it never did. If the grid covers only part of the scene, the primitive must overlap it.
  template <class Emit>
  bool for_each_voxel(scenes::PrimitiveId id, Emit emit) const {
    const scenes::Bounds bounds = scenes::primitive_bounds(*scene_, id);
    const CellRange range = cell_range(*grid_, bounds, tolerance_);
    glm::ivec3 corner(0);
    glm::ivec3 size(0);
    for (int axis = 0; axis < 3; ++axis) {
      const auto slot = static_cast<std::size_t>(axis);
      corner[axis] = range.first[slot];
      size[axis] = range.last[slot] - range.first[slot] + 1;
    }
    const bool row = (size.x > 1) + (size.y > 1) + (size.z > 1) <= 1 && holds(bounds);
    return split(id, corner, size, row || assign_ == Assign::kBounds, emit);
  }

 private:
  bool holds(const scenes::Bounds& bounds) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (bounds.lower[axis] < grid_->plane(axis, 0) ||
          bounds.upper[axis] > grid_->plane(axis, grid_->cells[axis])) {
        return false;
      }
    }
    return true;
  }

  /// Repeatedly halves a block of voxels that the primitive is known to overlap, until the few
  /// remaining voxels are tested one by one. The cost of a large primitive thus depends on its
  /// surface, not on the surrounding volume. `all`: the primitive is known to overlap each voxel.
  /// This is true for a row of voxels that contains the whole primitive, because the primitive's
  /// surface is connected.
  template <class Emit>
  bool split(scenes::PrimitiveId id, const glm::ivec3& corner, const glm::ivec3& size, bool all,
             Emit& emit) const {
    constexpr int kFew = 8;
    if (size.x <= kFew && size.y <= kFew && size.z <= kFew && size.x * size.y * size.z <= kFew) {
      return for_each_of_few(id, corner, size, all, emit);
    }
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    glm::ivec3 half = size;
    half[axis] = size[axis] / 2;
    glm::ivec3 rest = size;
    rest[axis] = size[axis] - half[axis];
    glm::ivec3 middle = corner;
    middle[axis] += half[axis];
    if ((all || reaches(id, corner, half)) && !split(id, corner, half, all, emit)) return false;
    return !(all || reaches(id, middle, rest)) || split(id, middle, rest, all, emit);
  }

  template <class Emit>
  bool for_each_of_few(scenes::PrimitiveId id, const glm::ivec3& corner, const glm::ivec3& size,
                       bool all, Emit& emit) const {
    const bool one = size == glm::ivec3(1);
    for (int z = 0; z < size.z; ++z) {
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          const glm::ivec3 voxel = corner + glm::ivec3(x, y, z);
          if (!all && !one && !reaches(id, voxel, glm::ivec3(1))) continue;
          if (!emit(voxel_index(*grid_, voxel))) return false;
        }
      }
    }
    return true;
  }

  bool reaches(scenes::PrimitiveId id, const glm::ivec3& corner, const glm::ivec3& size) const {
    return surface_overlaps(*scene_, id, grid_->box(corner, size), tolerance_);
  }

  const scenes::Scene* scene_;
  const CellGrid* grid_;
  Assign assign_;
  double tolerance_;
};

/// A reference of a voxel to a primitive.
struct VoxelReference {
  std::uint32_t voxel;
  scenes::PrimitiveId primitive;
};

/// Sorts references by voxel: those of voxel v become `references[first[v]]` up to but not
/// including `references[first[v + 1]]`, in the order in which they were found.
void sort_by_voxel(const std::vector<VoxelReference>& found, std::size_t voxels,
                   std::vector<std::uint32_t>& first, std::vector<scenes::PrimitiveId>& references);

}  // namespace beambench::accel::grid
