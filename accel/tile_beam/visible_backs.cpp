#include "accel/tile_beam/visible_backs.hpp"

#include <algorithm>

namespace beambench::accel::tile_beam {

VisibleBacks::VisibleBacks(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                           const glm::vec3& eye, std::size_t most_triangles) {
  const Solids& solids = hierarchy.solids;
  for (std::uint32_t number = 0; number < solids.solids.size(); ++number) {
    const Solid& solid = solids.solids[number];
    if (is_outside(scene, solids, solid, eye, most_triangles)) continue;
    meshlets_.resize(hierarchy.meshlets.size());
    const auto of_solid =
        std::ranges::equal_range(hierarchy.solid_meshlets, number, {}, &SolidMeshlet::solid);
    for (const SolidMeshlet& is_in : of_solid) meshlets_[is_in.meshlet] = 1;
  }
  if (meshlets_.empty()) return;
  nodes_.resize(hierarchy.nodes.size());
  for (std::size_t i = hierarchy.nodes.size(); i-- > 0;) {  // children before their parents
    const TileNode& node = hierarchy.nodes[i];
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      const TileChild child = node.children[lane];
      const bool leads =
          (child.kind() == TileChild::Kind::kMeshlet && meshlets_[child.index()] != 0) ||
          (child.kind() == TileChild::Kind::kNode && nodes_[child.index()] != 0);
      if (leads) nodes_[i] = static_cast<std::uint16_t>(nodes_[i] | 1U << lane);
    }
  }
}

}  // namespace beambench::accel::tile_beam
