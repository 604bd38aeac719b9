#pragma once
// Options of a hierarchy of grids.

#include <cstdint>
#include <vector>

#include "accel/grid/grid_layout.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::hierarchical_grid {

/// The maximum number of levels of grids.
inline constexpr int kMaxLevels = 5;

struct HierarchicalGridOptions : grid::GridLayout {
  HierarchicalGridOptions() { density = 0.2; }

  double inner_density = 1.0;     ///< voxels for each reference of the divided voxel
  std::uint32_t max_objects = 8;  ///< a voxel with more references is divided
  int max_level = 3;              ///< levels of grids, the top one being 1
  /// Divide only voxels in which a grid is expected to save time, or all voxels with enough
  /// references.
  enum class Divide { kGain, kAlways };
  Divide divide = Divide::kGain;
  /// The number of voxels of an inner grid: any, or the nearest power of two, the same along each
  /// axis (so that the planes of all grids lie on one lattice).
  enum class Inner { kAny, kPowers };
  Inner inner = Inner::kAny;
  bool mailboxes = true;

  static std::vector<ParameterInfo> parameters();
  static HierarchicalGridOptions from(const Parameters& parameters);
  /// Reads all options except `inner` and `mailboxes`, for structures that do not have these two.
  static HierarchicalGridOptions hierarchy_from(const Parameters& parameters);
};

}  // namespace beambench::accel::hierarchical_grid
