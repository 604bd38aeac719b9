#pragma once
// The solids whose backs an eye may see, because it is not clearly outside them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/tile_beam/tile_hierarchy.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::tile_beam {

class VisibleBacks {
 public:
  /// If the eye is in the box of a solid with more than `most_triangles`, it counts as inside the
  /// solid: an exact test would take longer than it saves.
  VisibleBacks(const TileHierarchy& hierarchy, const scenes::Scene& scene, const glm::vec3& eye,
               std::size_t most_triangles);

  /// Returns the triangles of a meshlet whose backs are invisible: one bit for each.
  std::uint32_t hidden(const TileHierarchy& hierarchy, std::uint32_t meshlet) const {
    if (!meshlets_.empty() && meshlets_[meshlet] != 0) return 0;
    return hierarchy.meshlets[meshlet].solid;
  }
  /// Returns the children of a node whose backs are all invisible: one bit for each.
  std::uint32_t hidden_lanes(const TileHierarchy& hierarchy, std::uint32_t node) const {
    const std::uint32_t lanes = hierarchy.nodes[node].cone_lanes;
    return nodes_.empty() ? lanes : lanes & ~std::uint32_t{nodes_[node]};
  }

 private:
  // Empty if the eye is outside all solids.
  std::vector<std::uint8_t> meshlets_;  ///< not 0: has triangles of a solid that the eye may be in
  std::vector<std::uint16_t> nodes_;    ///< bit i: child i leads to such a meshlet
};

}  // namespace beambench::accel::tile_beam
