#pragma once
// Options for laying out and filling a uniform grid of voxels.

#include <vector>

#include "accel/grid/grid_layout.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::grid {

struct VoxelGridOptions : GridLayout {
  enum class Fill { kLazy, kEager };

  Fill fill = Fill::kEager;
  bool mailboxes = false;

  static std::vector<ParameterInfo> parameters();
  static VoxelGridOptions from(const Parameters& parameters);
};

}  // namespace beambench::accel::grid
