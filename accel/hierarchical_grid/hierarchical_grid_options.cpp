#include "accel/hierarchical_grid/hierarchical_grid_options.hpp"

namespace beambench::accel::hierarchical_grid {

std::vector<ParameterInfo> HierarchicalGridOptions::parameters() {
  const HierarchicalGridOptions defaults;
  return {grid::resolution_parameter(),
          grid::density_parameter(defaults.density),
          real_parameter("inner_density", defaults.inner_density, 0.001, 1000.0,
                         "voxels of an inner grid for each reference of its voxel"),
          choice_parameter("shape", "cubic", {"cubic", "equal"},
                           "the voxels of a grid laid out by density: as cubic as possible, or "
                           "the same number along each axis"),
          choice_parameter("inner", "any", {"any", "powers"},
                           "the voxels of an inner grid: any number, or the nearest power of two "
                           "along each axis, the same for all axes, as in grid-beam"),
          integer_parameter("max_objects", defaults.max_objects, 0, 1'000'000,
                            "a voxel that refers to more primitives gets its own grid"),
          integer_parameter("max_level", defaults.max_level, 1, kMaxLevels,
                            "levels of grids, the grid of the scene being level 1"),
          choice_parameter(
              "divide", "gain", {"gain", "always"},
              "which of these voxels get a grid: those in which the surface area heuristic expects "
              "a grid to save a fifth of the time, or all"),
          grid::assign_parameter(),
          flag_parameter("mailboxes", defaults.mailboxes,
                         "never test a primitive twice against a ray; 4 bytes per primitive and "
                         "thread"),
          integer_parameter("max_voxels", defaults.max_voxels, 1, 2'000'000'000,
                            "refuse a top grid with more voxels, and stop making inner grids at "
                            "that total (4 bytes each)"),
          grid::max_references_parameter(defaults)};
}

HierarchicalGridOptions HierarchicalGridOptions::from(const Parameters& parameters) {
  HierarchicalGridOptions options = hierarchy_from(parameters);
  options.inner = parameters.choice("inner") == "powers" ? Inner::kPowers : Inner::kAny;
  options.mailboxes = parameters.flag("mailboxes");
  return options;
}

HierarchicalGridOptions HierarchicalGridOptions::hierarchy_from(const Parameters& parameters) {
  HierarchicalGridOptions options;
  options.resolution = parameters.cells("resolution");
  options.density = parameters.real("density");
  options.inner_density = parameters.real("inner_density");
  options.shape = parameters.choice("shape") == "equal" ? grid::Shape::kEqual : grid::Shape::kCubic;
  options.max_objects = static_cast<std::uint32_t>(parameters.integer("max_objects"));
  options.max_level = static_cast<int>(parameters.integer("max_level"));
  options.divide = parameters.choice("divide") == "always"
                       ? HierarchicalGridOptions::Divide::kAlways
                       : HierarchicalGridOptions::Divide::kGain;
  options.assign = grid::assign_of(parameters);
  options.max_voxels = parameters.integer("max_voxels");
  options.max_references = static_cast<std::uint64_t>(parameters.integer("max_references"));
  return options;
}

}  // namespace beambench::accel::hierarchical_grid
