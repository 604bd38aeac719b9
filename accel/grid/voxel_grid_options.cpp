#include "accel/grid/voxel_grid_options.hpp"

namespace beambench::accel::grid {

std::vector<ParameterInfo> VoxelGridOptions::parameters() {
  const VoxelGridOptions defaults;
  return {resolution_parameter(),
          density_parameter(defaults.density),
          assign_parameter(),
          choice_parameter("fill", "eager", {"lazy", "eager"},
                           "when a voxel's list is made: when the first ray visits the voxel, by "
                           "testing every primitive (thesis), or before the first ray"),
          flag_parameter("mailboxes", defaults.mailboxes,
                         "never test a primitive twice against a ray; 4 bytes per primitive "
                         "and thread"),
          integer_parameter("max_voxels", defaults.max_voxels, 1, 2'000'000'000,
                            "refuse grids with more voxels (4 bytes each, 8 if fill is lazy)"),
          max_references_parameter(defaults)};
}

VoxelGridOptions VoxelGridOptions::from(const Parameters& parameters) {
  VoxelGridOptions options;
  options.resolution = parameters.cells("resolution");
  options.density = parameters.real("density");
  options.assign = assign_of(parameters);
  options.fill = parameters.choice("fill") == "lazy" ? Fill::kLazy : Fill::kEager;
  options.mailboxes = parameters.flag("mailboxes");
  options.max_voxels = parameters.integer("max_voxels");
  options.max_references = static_cast<std::uint64_t>(parameters.integer("max_references"));
  return options;
}

}  // namespace beambench::accel::grid
