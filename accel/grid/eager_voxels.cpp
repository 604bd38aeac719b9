#include "accel/grid/eager_voxels.hpp"

#include <algorithm>
#include <numeric>

#include "accel/core/tolerance.hpp"
#include "accel/grid/voxel_grid_options.hpp"
#include "accel/grid/voxel_walk.hpp"

namespace beambench::accel::grid {

namespace {

struct Entry {
  std::uint32_t voxel;
  scenes::PrimitiveId primitive;
};

/// Finds the voxels that one primitive after the other reaches into.
class Rasterizer {
 public:
  Rasterizer(const scenes::Scene& scene, const CellGrid& grid, std::uint64_t max_references)
      : scene_(scene),
        grid_(grid),
        tolerance_(overlap_tolerance(scene)),
        max_references_(max_references) {
    entries_.reserve(scene.primitives.size());
  }

  void add(scenes::PrimitiveId id) {
    const CellRange range = cell_range(grid_, scenes::primitive_bounds(scene_, id), tolerance_);
    glm::ivec3 corner(0);
    glm::ivec3 size(0);
    for (int axis = 0; axis < 3; ++axis) {
      const auto slot = static_cast<std::size_t>(axis);
      corner[axis] = range.first[slot];
      size[axis] = range.last[slot] - range.first[slot] + 1;
    }
    const bool line = (size.x > 1) + (size.y > 1) + (size.z > 1) <= 1;
    split(id, corner, size, line);
  }

  std::vector<Entry> take_entries() && { return std::move(entries_); }

 private:
  /// Halves a block of voxels that the primitive is known to reach into, down to single ones: the
  /// cost of a large primitive depends on its surface, not on the volume around it. In a row of
  /// voxels that holds the whole primitive its surface, being connected, crosses each: no test is
  /// needed.
  void split(scenes::PrimitiveId id, const glm::ivec3& corner, const glm::ivec3& size, bool row) {
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    if (size[axis] == 1) {
      emit(id, corner);
      return;
    }
    glm::ivec3 half = size;
    half[axis] = size[axis] / 2;
    glm::ivec3 rest = size;
    rest[axis] = size[axis] - half[axis];
    glm::ivec3 middle = corner;
    middle[axis] += half[axis];
    if (row || reaches(id, corner, half)) split(id, corner, half, row);
    if (row || reaches(id, middle, rest)) split(id, middle, rest, row);
  }

  bool reaches(scenes::PrimitiveId id, const glm::ivec3& corner, const glm::ivec3& size) const {
    return surface_overlaps(scene_, id, grid_.box(corner, size), tolerance_);
  }

  void emit(scenes::PrimitiveId id, const glm::ivec3& voxel) {
    if (entries_.size() == max_references_)
      fail_too_many_references(scene_, grid_, max_references_);
    entries_.push_back({static_cast<std::uint32_t>(voxel_index(grid_, voxel)), id});
  }

  const scenes::Scene& scene_;
  const CellGrid& grid_;
  double tolerance_;
  std::uint64_t max_references_;
  std::vector<Entry> entries_;
};

}  // namespace

EagerVoxels::EagerVoxels(const scenes::Scene& scene, const CellGrid& grid,
                         std::uint64_t max_references) {
  Rasterizer rasterizer(scene, grid, max_references);
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) rasterizer.add(id);
  const std::vector<Entry> entries = std::move(rasterizer).take_entries();

  // A stable counting sort by voxel: ids stay in increasing order. While it runs, first_[v + 1] is
  // where the next reference of voxel v goes; at the end that is where voxel v + 1 begins.
  first_.resize(voxel_count(grid) + 1);
  for (const Entry& entry : entries) {
    if (entry.voxel + 2 < first_.size()) ++first_[entry.voxel + 2];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  references_.resize(entries.size());
  for (const Entry& entry : entries) references_[first_[entry.voxel + 1]++] = entry.primitive;
}

void EagerVoxels::describe(Statistics& statistics) const {
  const std::size_t voxels = first_.size() - 1;
  for (std::size_t voxel = 0; voxel < voxels; ++voxel) {
    if (first_[voxel] == first_[voxel + 1]) ++statistics.empty_leaves;
  }
  statistics.references = references_.size();
  statistics.bytes += first_.capacity() * sizeof(std::uint32_t) +
                      references_.capacity() * sizeof(scenes::PrimitiveId);
}

}  // namespace beambench::accel::grid
