#pragma once
// The voxels' lists, all built in advance.

#include <cstdint>
#include <span>
#include <vector>

#include "accel/core/cell_grid.hpp"
#include "accel/core/statistics.hpp"
#include "accel/grid/assign.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::grid {

/// A list for each voxel, one after another: the primitives whose surface (or box, depending on
/// `Assign`) overlaps the closed voxel, widened by `overlap_tolerance`, in order of id.
class EagerVoxels {
 public:
  /// Throws an InputError that names `max_references` if the lists have more references.
  EagerVoxels(const scenes::Scene& scene, const CellGrid& grid, std::uint64_t max_references,
              Assign assign = Assign::kSurface);

  std::span<const scenes::PrimitiveId> references(std::size_t voxel) const {
    return {references_.data() + first_[voxel], first_[voxel + 1] - first_[voxel]};
  }
  bool holds_references(std::size_t voxel) const { return !references(voxel).empty(); }
  /// Fills in all statistics except those of the grid itself.
  void describe(Statistics& statistics) const;

 private:
  std::vector<std::uint32_t> first_;  ///< start of each voxel's list, then the end of the last list
  std::vector<scenes::PrimitiveId> references_;
};

}  // namespace beambench::accel::grid
