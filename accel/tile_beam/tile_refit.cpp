#include "accel/tile_beam/tile_refit.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "accel/bvh/refit.hpp"
#include "accel/core/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"

namespace beambench::accel::tile_beam {
namespace {

/// Copies coordinates to blocks, and returns their boxes, widened.
class Refill {
 public:
  Refill(TileHierarchy& hierarchy, const scenes::Scene& scene)
      : hierarchy_(&hierarchy), scene_(&scene), tolerance_(overlap_tolerance(scene)) {}

  scenes::Bounds operator()(TileChild child) const {
    switch (child.kind()) {
      case TileChild::Kind::kMeshlet:
        return meshlet(child.index());
      case TileChild::Kind::kSpheres:
        return spheres(hierarchy_->spheres[child.index()]);
      case TileChild::Kind::kCones:
        return cones(hierarchy_->cones[child.index()]);
      case TileChild::Kind::kNode:
        break;
    }
    return {};
  }

 private:
  scenes::Bounds meshlet(std::size_t index) const {
    Meshlet& meshlet = hierarchy_->meshlets[index];
    const MeshletVertices& numbers = hierarchy_->meshlet_vertices[index];
    scenes::Bounds box;
    for (std::size_t i = 0; i < meshlet.vertex_count; ++i) {
      const glm::vec3& place = scene_->vertices[numbers[i]];
      for (int axis = 0; axis < 3; ++axis) {
        meshlet.vertices[static_cast<std::size_t>(axis)][i] = place[axis];
      }
      box.include(place);
    }
    box = padded(box, tolerance_);
    const glm::vec3 sides = box.extent();
    meshlet.extent = std::max({sides.x, sides.y, sides.z});
    return box;
  }

  scenes::Bounds spheres(SphereBlock& block) const {
    scenes::Bounds box;
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      const scenes::PrimitiveId id = block.primitives[lane];
      const glm::vec3& center = scene_->spheres[scene_->primitives[id].index].center;
      for (int axis = 0; axis < 3; ++axis) {
        block.center[static_cast<std::size_t>(axis)][lane] = center[axis];
      }
      box.include(primitive_box(id));
    }
    return box;
  }

  scenes::Bounds cones(ConeBlock& block) const {
    scenes::Bounds box;
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      const scenes::Bounds own = primitive_box(block.primitives[lane]);
      block.boxes.set(lane, own);
      box.include(own);
    }
    return box;
  }

  scenes::Bounds primitive_box(scenes::PrimitiveId id) const {
    return padded(scenes::primitive_bounds(*scene_, id), tolerance_);
  }

  TileHierarchy* hierarchy_;
  const scenes::Scene* scene_;
  double tolerance_;
};

bool is_node(TileChild child) { return child.kind() == TileChild::Kind::kNode; }

scenes::Bounds box_of(const TileNode& node) {
  scenes::Bounds box;
  for (std::size_t lane = 0; lane < node.count; ++lane) box.include(node.boxes.get(lane));
  return box;
}

}  // namespace

void refit(TileHierarchy& hierarchy, const scenes::Scene& scene, bool parallel) {
  hierarchy.is_refit = true;
  if (hierarchy.empty()) return;
  const Refill refill(hierarchy, scene);
  const auto refill_leaves = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      TileNode& node = hierarchy.nodes[i];
      for (std::size_t lane = 0; lane < node.count; ++lane) {
        if (!is_node(node.children[lane])) node.boxes.set(lane, refill(node.children[lane]));
      }
    }
  };
  if (parallel) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, hierarchy.nodes.size(), 64),
                      [&](const auto& range) { refill_leaves(range.begin(), range.end()); });
  } else {
    refill_leaves(0, hierarchy.nodes.size());
  }
  for (std::size_t i = hierarchy.nodes.size(); i-- > 0;) {  // children follow their parents
    TileNode& node = hierarchy.nodes[i];
    for (std::size_t lane = 0; lane < node.count; ++lane) {
      const TileChild child = node.children[lane];
      if (is_node(child)) node.boxes.set(lane, box_of(hierarchy.nodes[child.index()]));
    }
  }
  hierarchy.bounds = is_node(hierarchy.root) ? box_of(hierarchy.nodes[hierarchy.root.index()])
                                             : refill(hierarchy.root);
  if (hierarchy.stream_bvh.empty()) return;
  bvh::refit(hierarchy.stream_bvh, scene, parallel);
  hierarchy.stream_tree =
      bvh::build_stream_tree(hierarchy.stream_bvh, parallel, std::move(hierarchy.stream_tree));
}

}  // namespace beambench::accel::tile_beam
