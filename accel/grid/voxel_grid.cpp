#include "accel/grid/voxel_grid.hpp"

#include "accel/core/registry.hpp"
#include "accel/grid/eager_voxels.hpp"
#include "accel/grid/lazy_voxels.hpp"

namespace beambench::accel::grid {

namespace {

template <class Voxels>
std::unique_ptr<Accelerator> build(const scenes::Scene& scene, const VoxelGridOptions& options) {
  if (options.mailboxes) return std::make_unique<VoxelGrid<Voxels, Mailboxes>>(scene, options);
  return std::make_unique<VoxelGrid<Voxels, NoMailboxes>>(scene, options);
}

}  // namespace

void register_grid(Registry& registry) {
  registry.add({"voxel-grid",
                "a uniform grid of voxels with the incremental traversal of Amanatides and Woo "
                "(1987), filled when rays enter its voxels, as in the thesis, or in advance",
                Conformance::kBitExact, VoxelGridOptions::parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters, const Workload&) {
                  const auto options = VoxelGridOptions::from(parameters);
                  return options.fill == VoxelGridOptions::Fill::kLazy
                             ? build<LazyVoxels>(scene, options)
                             : build<EagerVoxels>(scene, options);
                }});
}

}  // namespace beambench::accel::grid
