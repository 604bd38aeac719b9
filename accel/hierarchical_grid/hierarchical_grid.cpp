#include "accel/hierarchical_grid/hierarchical_grid.hpp"

#include <memory>

#include "accel/core/registry.hpp"
#include "accel/grid/mailboxes.hpp"

namespace beambench::accel::hierarchical_grid {

void register_hierarchical_grid(Registry& registry) {
  registry.add({"hierarchical-grid",
                "grids in the voxels of a grid that refer to many primitives (Jevans and Wyvill "
                "1989), traversed as Amanatides and Woo (1987) traverse one grid",
                Conformance::kBitExact, HierarchicalGridOptions::parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters,
                   const Workload&) -> std::unique_ptr<Accelerator> {
                  const auto options = HierarchicalGridOptions::from(parameters);
                  if (options.mailboxes) {
                    return std::make_unique<HierarchicalGrid<grid::Mailboxes>>(scene, options);
                  }
                  return std::make_unique<HierarchicalGrid<NoMailboxes>>(scene, options);
                }});
}

}  // namespace beambench::accel::hierarchical_grid
