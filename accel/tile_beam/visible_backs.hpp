#pragma once
// For one eye: the solids whose backs it may see, because it is not clearly outside of them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/tile_beam/tile_hierarchy.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::tile_beam {

class VisibleBacks {
 public:
  /// A solid of more than `most_triangles` in whose box the eye is counts as one that the eye is
  /// in: to find out would take longer than is gained.
  VisibleBacks(const TileHierarchy& hierarchy, const scenes::Scene& scene, const glm::vec3& eye,
               std::size_t most_triangles);

  /// The triangles of a meshlet whose backs cannot be seen: one bit for each.
  std::uint32_t hidden(const TileHierarchy& hierarchy, std::uint32_t meshlet) const {
    if (!meshlets_.empty() && meshlets_[meshlet] != 0) return 0;
    return hierarchy.meshlets[meshlet].solid;
  }
  /// The children of a node of which only fronts can be seen: one bit for each.
  std::uint32_t hidden_lanes(const TileHierarchy& hierarchy, std::uint32_t node) const {
    const std::uint32_t lanes = hierarchy.nodes[node].cone_lanes;
    return nodes_.empty() ? lanes : lanes & ~std::uint32_t{nodes_[node]};
  }

 private:
  // Empty where the eye is outside of all solids.
  std::vector<std::uint8_t> meshlets_;  ///< not 0: has triangles of a solid that the eye may be in
  std::vector<std::uint16_t> nodes_;    ///< bit i: child i leads to such a meshlet
};

}  // namespace beambench::accel::tile_beam
