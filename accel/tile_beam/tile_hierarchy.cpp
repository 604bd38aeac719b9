#include "accel/tile_beam/tile_hierarchy.hpp"

#include <algorithm>
#include <span>

#include "accel/bvh/bvh_builder.hpp"
#include "accel/bvh/padded_bounds.hpp"
#include "accel/tile_beam/leaf_packer.hpp"
#include "accel/tolerance.hpp"

namespace beambench {
namespace {

Bounds triangle_bounds(const Scene& scene, const Triangle& triangle) {
  Bounds bounds;
  for (const std::uint32_t vertex : triangle.vertex) bounds.include(scene.vertices[vertex]);
  return bounds;
}

/// Turns the binary hierarchy over a scene's pieces into the wide one.
class Builder {
 public:
  Builder(const Scene& scene, const TileHierarchyOptions& options) : scene_(scene) {
    collect_pieces();
    BvhOptions binary;
    binary.max_leaf = options.max_leaf;
    binary.block_size = kTileLanes;
    binary.parallel = options.parallel;
    binary_ = build_bvh(boxes_, binary);
    wide_.cost = sah_cost(binary_, binary);
  }

  TileHierarchy build() {
    wide_.references = pieces_.size();
    if (pieces_.empty()) return std::move(wide_);
    reserve();
    LeafPacker packer(scene_, pieces_, boxes_, wide_);
    packer_ = &packer;
    const Made root = convert(0, 1);
    wide_.root = root.child;
    wide_.bounds = root.box;
    return std::move(wide_);
  }

 private:
  struct Made {
    TileChild child;
    Bounds box;
    std::uint32_t leaves;
  };

  void collect_pieces() {
    const double tolerance = overlap_tolerance(scene_);
    const std::size_t count = scene_.triangles.size() + scene_.spheres.size() + scene_.cones.size();
    boxes_.reserve(count);
    pieces_.reserve(count);
    for (std::uint32_t i = 0; i < scene_.triangles.size(); ++i) {
      pieces_.push_back({scene_.triangles[i].primitive, i});
      boxes_.push_back(padded(triangle_bounds(scene_, scene_.triangles[i]), tolerance));
    }
    for (PrimitiveId id = 0; id < scene_.primitives.size(); ++id) {
      if (scene_.primitives[id].kind == PrimitiveKind::kPolygon) continue;
      pieces_.push_back({id, scene_.primitives[id].index});
      boxes_.push_back(padded(primitive_bounds(scene_, id), tolerance));
    }
  }

  /// About as much as will be needed.
  void reserve() {
    const std::size_t leaves = (binary_.nodes.size() + 1) / 2;
    wide_.nodes.reserve(leaves / 8 + 1);
    wide_.meshlets.reserve(leaves * scene_.triangles.size() / pieces_.size());
    wide_.spheres.reserve(leaves * scene_.spheres.size() / pieces_.size());
    wide_.cones.reserve(leaves * scene_.cones.size() / pieces_.size());
  }

  /// The recursion is bounded by kMaxBvhDepth.
  Made convert(std::uint32_t binary_node, std::uint32_t depth) {
    const BvhNode& node = binary_.nodes[binary_node];
    if (node.is_leaf()) return convert_leaf(node, depth);
    std::array<std::uint32_t, kTileLanes> children{};
    const std::size_t count = gather_children(binary_, binary_node, children);
    const auto index = static_cast<std::uint32_t>(wide_.nodes.size());
    wide_.nodes.emplace_back();
    std::array<Made, kTileLanes> made{};
    for (std::size_t lane = 0; lane < count; ++lane)
      made[lane] = convert(children[lane], depth + 1);
    return fill(index, std::span(made).first(count));
  }

  Made convert_leaf(const BvhNode& node, std::uint32_t depth) {
    const auto items = std::span(binary_.items).subspan(node.first, node.count);
    std::sort(items.begin(), items.end());
    const std::span<const PackedLeaf> packed = packer_->pack(items);
    wide_.depth = std::max(wide_.depth, packed.size() == 1 ? depth : depth + 1);
    if (packed.size() == 1) return {packed[0].child, packed[0].box, 1};
    const auto index = static_cast<std::uint32_t>(wide_.nodes.size());
    wide_.nodes.emplace_back();
    std::array<Made, kTileLanes> made{};
    for (std::size_t lane = 0; lane < packed.size(); ++lane) {
      made[lane] = {packed[lane].child, packed[lane].box, 1};
    }
    return fill(index, std::span(made).first(packed.size()));
  }

  Made fill(std::uint32_t index, std::span<const Made> made) {
    TileNode& node = wide_.nodes[index];
    Made whole{TileChild(TileChild::Kind::kNode, index), {}, 0};
    node.count = static_cast<std::uint32_t>(made.size());
    for (std::size_t lane = 0; lane < made.size(); ++lane) {
      node.boxes.set(lane, made[lane].box);
      node.children[lane] = made[lane].child;
      node.leaves[lane] = made[lane].leaves;
      whole.box.include(made[lane].box);
      whole.leaves += made[lane].leaves;
    }
    return whole;
  }

  const Scene& scene_;
  std::vector<TilePiece> pieces_;
  std::vector<Bounds> boxes_;
  BinaryBvh binary_;
  TileHierarchy wide_;
  LeafPacker* packer_ = nullptr;
};

}  // namespace

TileHierarchy build_tile_hierarchy(const Scene& scene, const TileHierarchyOptions& options) {
  return Builder(scene, options).build();
}

}  // namespace beambench
