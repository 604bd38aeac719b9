#pragma once
// How a hierarchy of grids is made.

#include <cstdint>
#include <vector>

#include "accel/grid/grid_layout.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::hierarchical_grid {

/// The levels of grids that there can be.
inline constexpr int kMaxLevels = 5;

struct HierarchicalGridOptions : grid::GridLayout {
  HierarchicalGridOptions() { density = 0.2; }

  double inner_density = 1.0;     ///< voxels for each reference of the voxel that is divided
  std::uint32_t max_objects = 8;  ///< a voxel that refers to more is divided
  int max_level = 3;              ///< levels of grids, the top one being 1
  /// Only voxels in which a grid is expected to save time, or all that refer to so many.
  enum class Divide { kGain, kAlways };
  Divide divide = Divide::kGain;
  /// The number of voxels of a grid in a voxel: any, or the nearest power of two along each axis,
  /// the same for all (so that the planes of all grids lie on one lattice).
  enum class Inner { kAny, kPowers };
  Inner inner = Inner::kAny;
  bool mailboxes = true;

  static std::vector<ParameterInfo> parameters();
  static HierarchicalGridOptions from(const Parameters& parameters);
  /// Without `inner` and `mailboxes`, where these are not to be chosen.
  static HierarchicalGridOptions hierarchy_from(const Parameters& parameters);
};

}  // namespace beambench::accel::hierarchical_grid
