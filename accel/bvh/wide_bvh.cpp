#include "accel/bvh/wide_bvh.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "accel/bvh/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/core/error.hpp"

namespace beambench::accel::bvh {
namespace {

/// What a leaf refers to: a triangle of a polygon, or a whole sphere or cone.
struct Piece {
  scenes::PrimitiveId primitive;
  std::uint32_t index;  ///< into the scene's triangles, spheres or cones
};

scenes::Bounds triangle_bounds(const scenes::Scene& scene, std::uint32_t triangle) {
  scenes::Bounds bounds;
  for (const std::uint32_t vertex : scene.triangles[triangle].vertex) {
    bounds.include(scene.vertices[vertex]);
  }
  return bounds;
}

/// Turns the binary hierarchy over a scene's pieces into the wide one.
class WideBvhBuilder {
 public:
  WideBvhBuilder(const scenes::Scene& scene, const BvhOptions& options) : scene_(scene) {
    const std::vector<scenes::Bounds> boxes = collect_pieces();
    binary_ = build_bvh(boxes, options);
    wide_.cost = sah_cost(binary_, options);
  }

  WideBvh build() {
    wide_.scene_bounds = scene_.bounds;
    wide_.references = pieces_.size();
    if (!pieces_.empty()) wide_.root = convert(0, 1);
    wide_.nodes.shrink_to_fit();
    wide_.blocks.shrink_to_fit();
    return std::move(wide_);
  }

 private:
  std::vector<scenes::Bounds> collect_pieces() {
    const double tolerance = overlap_tolerance(scene_);
    std::vector<scenes::Bounds> boxes;
    const std::size_t count = scene_.triangles.size() + scene_.spheres.size() + scene_.cones.size();
    boxes.reserve(count);
    pieces_.reserve(count);
    for (scenes::PrimitiveId id = 0; id < scene_.primitives.size(); ++id) {
      const scenes::Primitive& primitive = scene_.primitives[id];
      if (primitive.kind != scenes::PrimitiveKind::kPolygon) {
        pieces_.push_back({id, primitive.index});
        boxes.push_back(padded(scenes::primitive_bounds(scene_, id), tolerance));
        continue;
      }
      const scenes::Polygon& polygon = scene_.polygons[primitive.index];
      for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
        pieces_.push_back({id, polygon.first_triangle + i});
        boxes.push_back(padded(triangle_bounds(scene_, polygon.first_triangle + i), tolerance));
      }
    }
    return boxes;
  }

  /// The recursion is bounded by kMaxBvhDepth.
  ChildReference convert(std::uint32_t binary_node, std::uint32_t depth) {
    const BvhNode& node = binary_.nodes[binary_node];
    wide_.depth = std::max(wide_.depth, depth);
    if (node.is_leaf()) return make_leaf(node);
    std::array<std::uint32_t, kBvhLanes> children{};
    const std::size_t count = gather_children(binary_, binary_node, children);
    const auto index = static_cast<std::uint32_t>(wide_.nodes.size());
    wide_.nodes.push_back(make_node(std::span(children).first(count)));
    for (std::size_t lane = 0; lane < count; ++lane) {
      const ChildReference child = convert(children[lane], depth + 1);
      wide_.nodes[index].children[lane] = child;
    }
    return ChildReference::node(index);
  }

  WideNode make_node(std::span<const std::uint32_t> children) const {
    WideNode node{};
    node.count = static_cast<std::uint32_t>(children.size());
    for (std::size_t lane = 0; lane < kBvhLanes; ++lane) {
      const scenes::Bounds box =
          lane < children.size() ? binary_.nodes[children[lane]].box : scenes::Bounds{};  // empty
      for (int axis = 0; axis < 3; ++axis) {
        const auto row = static_cast<std::size_t>(axis);
        node.planes[row][lane] = box.lower[axis];
        node.planes[row + 3][lane] = box.upper[axis];
      }
    }
    return node;
  }

  /// Blocks of one kind each, kind by kind, in increasing id.
  ChildReference make_leaf(const BvhNode& leaf) {
    ++wide_.leaves;
    const auto first_block = static_cast<std::uint32_t>(wide_.blocks.size());
    const glm::vec3 sides = leaf.box.extent();
    const float extent = std::max({sides.x, sides.y, sides.z});
    const auto items = std::span(binary_.items).subspan(leaf.first, leaf.count);
    std::sort(items.begin(), items.end());
    for (const scenes::PrimitiveKind kind :
         {scenes::PrimitiveKind::kPolygon, scenes::PrimitiveKind::kSphere,
          scenes::PrimitiveKind::kCone}) {
      PrimitiveBlock* block = nullptr;
      for (const std::uint32_t item : items) {
        if (scene_.primitives[pieces_[item].primitive].kind != kind) continue;
        if (block == nullptr || block->count == kBvhLanes) {
          block = &wide_.blocks.emplace_back();
          block->kind = kind;
          block->leaf_extent = extent;
        }
        append(pieces_[item], *block);
      }
    }
    if (wide_.blocks.size() > ChildReference::kBlockIndices) {
      throw InputError(
          fmt::format("sah-bvh over '{}' needs more than {} leaf blocks; use a scene "
                      "with fewer primitives",
                      scene_.name, ChildReference::kBlockIndices));
    }
    return ChildReference::leaf(first_block,
                                static_cast<std::uint32_t>(wide_.blocks.size()) - first_block);
  }

  void append(const Piece& piece, PrimitiveBlock& block) const {
    const std::size_t lane = block.count++;
    block.primitives[lane] = piece.primitive;
    const auto put = [&](std::size_t first_row, const glm::vec3& point) {
      for (int axis = 0; axis < 3; ++axis) {
        block.coordinates[first_row + static_cast<std::size_t>(axis)][lane] = point[axis];
      }
    };
    if (block.kind == scenes::PrimitiveKind::kPolygon) {
      for (std::size_t i = 0; i < 3; ++i) {
        put(3 * i, scene_.vertices[scene_.triangles[piece.index].vertex[i]]);
      }
    } else if (block.kind == scenes::PrimitiveKind::kSphere) {
      put(0, scene_.spheres[piece.index].center);
      block.coordinates[3][lane] = scene_.spheres[piece.index].radius;
    }
  }

  const scenes::Scene& scene_;
  std::vector<Piece> pieces_;
  BinaryBvh binary_;
  WideBvh wide_;
};

}  // namespace

WideBvh build_wide_bvh(const scenes::Scene& scene, const BvhOptions& options) {
  return WideBvhBuilder(scene, options).build();
}

}  // namespace beambench::accel::bvh
