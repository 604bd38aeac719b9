#include "accel/tile_beam/tile_hierarchy.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "accel/bvh/bvh_builder.hpp"
#include "accel/bvh/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/tile_beam/leaf_packer.hpp"

namespace beambench::accel::tile_beam {
namespace {

scenes::Bounds triangle_bounds(const scenes::Scene& scene, const scenes::Triangle& triangle) {
  scenes::Bounds bounds;
  for (const std::uint32_t vertex : triangle.vertex) bounds.include(scene.vertices[vertex]);
  return bounds;
}

struct Pieces {
  std::vector<TilePiece> pieces;
  std::vector<scenes::Bounds> boxes;
};

Pieces pieces_of(const scenes::Scene& scene) {
  Pieces all;
  const double tolerance = overlap_tolerance(scene);
  const std::size_t count = scene.triangles.size() + scene.spheres.size() + scene.cones.size();
  all.boxes.reserve(count);
  all.pieces.reserve(count);
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    all.pieces.push_back({scene.triangles[i].primitive, i, scenes::PrimitiveKind::kPolygon});
    all.boxes.push_back(bvh::padded(triangle_bounds(scene, scene.triangles[i]), tolerance));
  }
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const auto& primitive = scene.primitives[id];
    if (primitive.kind == scenes::PrimitiveKind::kPolygon) continue;
    all.pieces.push_back({id, primitive.index, primitive.kind});
    all.boxes.push_back(bvh::padded(scenes::primitive_bounds(scene, id), tolerance));
  }
  return all;
}

/// Turns the binary hierarchy over a scene's pieces into the wide one.
class Builder {
 public:
  Builder(const scenes::Scene& scene, const TileHierarchyOptions& options) {
    const Pieces all = pieces_of(scene);
    wide_.references = all.pieces.size();
    if (wide_.empty()) return;
    bvh::BvhOptions binary;
    binary.max_leaf = options.max_leaf;
    binary.block_size = kTileLanes;
    binary.parallel = options.parallel;
    binary_ = bvh::build_bvh(all.boxes, binary);
    wide_.cost = bvh::sah_cost(binary_, binary);
    wide_.visits = ExpectedVisits(scene.bounds);
    pack({scene, all.pieces, all.boxes}, options.parallel);
    wide_.nodes.reserve(binary_.nodes.size() / 16 + 1);
    const Made root = convert(0, 1);
    wide_.root = root.child;
    wide_.bounds = root.box;
  }

  TileHierarchy take() { return std::move(wide_); }

 private:
  struct Made {
    TileChild child;
    scenes::Bounds box;
    std::uint32_t leaves;
  };

  /// Packs all leaves, in the order of nodes, and numbers them: `first` of a leaf's node becomes
  /// its number.
  void pack(const TilePieces& pieces, bool parallel) {
    std::vector<std::span<const std::uint32_t>> leaves;
    leaves.reserve((binary_.nodes.size() + 1) / 2);
    for (bvh::BvhNode& node : binary_.nodes) {
      if (!node.is_leaf()) continue;
      const auto items = std::span(binary_.items).subspan(node.first, node.count);
      std::sort(items.begin(), items.end());
      node.first = static_cast<std::uint32_t>(leaves.size());
      leaves.push_back(items);
    }
    packed_ = pack_leaves(pieces, leaves, parallel);
    static_cast<TileBlocks&>(wide_) = std::move(packed_.blocks);
  }

  /// The recursion is bounded by kMaxBvhDepth.
  Made convert(std::uint32_t binary_node, std::uint32_t depth) {
    const bvh::BvhNode& node = binary_.nodes[binary_node];
    if (node.is_leaf()) {
      wide_.visits.add_leaf(node.box, node.count);
    } else {
      wide_.visits.add_node(node.box);
    }
    if (node.is_leaf()) return convert_leaf(packed_.of(node.first), depth);
    std::array<std::uint32_t, kTileLanes> children{};
    const std::size_t count = bvh::gather_children(binary_, binary_node, children);
    const auto index = static_cast<std::uint32_t>(wide_.nodes.size());
    wide_.nodes.emplace_back();
    std::array<Made, kTileLanes> made{};
    for (std::size_t lane = 0; lane < count; ++lane)
      made[lane] = convert(children[lane], depth + 1);
    return fill(index, std::span(made).first(count));
  }

  Made convert_leaf(std::span<const PackedLeaf> packed, std::uint32_t depth) {
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

  bvh::BinaryBvh binary_;
  PackedLeaves packed_;
  TileHierarchy wide_;
};

}  // namespace

TileHierarchy build_tile_hierarchy(const scenes::Scene& scene,
                                   const TileHierarchyOptions& options) {
  return Builder(scene, options).take();
}

}  // namespace beambench::accel::tile_beam
