#include "accel/bvh/wide_bvh.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "accel/bvh/bvh_layout.hpp"
#include "accel/bvh/collapse.hpp"
#include "accel/bvh/lbvh_builder.hpp"
#include "accel/bvh/ploc_builder.hpp"
#include "accel/bvh/reinsertion.hpp"
#include "accel/bvh/spatial_builder.hpp"
#include "accel/bvh/sweep_builder.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::bvh {
namespace {

/// The cost of a binary node that the collapse may remove, relative to testing a primitive: a third
/// of a wide node's cost, since three levels become one (CollapseCosts).
constexpr float kNodeInPrimitives = 3.0F;

/// Returns options for a builder that makes small leaves, because they will be merged.
BvhOptions before_collapse(BvhOptions options) {
  options.block_size = 1;
  options.node_cost = kNodeInPrimitives;
  return options;
}

/// Converts the binary hierarchy over a scene's parts into the wide one.
class WideBvhBuilder {
 public:
  WideBvhBuilder(const scenes::Scene& scene, std::vector<PrimitivePart> parts, BinaryBvh binary)
      : scene_(scene), parts_(std::move(parts)), binary_(std::move(binary)) {}

  void collapse(std::uint32_t max_leaf) {
    CollapseCosts costs;
    costs.max_leaf = max_leaf;
    collapse_.emplace(binary_, costs);
  }

  WideBvh build() {
    wide_.scene_bounds = scene_.bounds;
    wide_.visits = ExpectedVisits(scene_.bounds);
    reserve();
    if (!binary_.nodes.empty()) wide_.root = convert(0, 1);
    wide_.nodes.shrink_to_fit();
    wide_.blocks.shrink_to_fit();
    return std::move(wide_);
  }

 private:
  /// Reserves space for a typical hierarchy over triangles only, so that it is not copied as it
  /// grows.
  void reserve() {
    if (collapse_) return;
    std::size_t blocks = 0;
    std::size_t leaves = 0;
    for (const BvhNode& node : binary_.nodes) {
      if (!node.is_leaf()) continue;
      ++leaves;
      blocks += (node.count + kBvhLanes - 1) / kBvhLanes;
    }
    wide_.blocks.reserve(blocks);
    wide_.nodes.reserve(leaves / 3);
  }

  /// Converts a node and its descendants. The depth of the recursion is at most kMaxBvhDepth.
  ChildReference convert(std::uint32_t binary_node, std::uint32_t depth) {
    const BvhNode& node = binary_.nodes[binary_node];
    wide_.depth = std::max(wide_.depth, depth);
    if (node.is_leaf()) return make_leaf(node.box, node.first, node.count);
    if (collapse_ && collapse_->is_leaf(binary_node)) {
      return make_leaf(node.box, collapse_->first_item(binary_node),
                       collapse_->item_count(binary_node));
    }
    wide_.visits.add_node(node.box);
    std::array<std::uint32_t, kBvhLanes> children{};
    const std::size_t count = collapse_ ? collapse_->children_of(binary_node, children)
                                        : gather_children(binary_, binary_node, children);
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
    for (std::size_t lane = 0; lane < kBvhLanes; ++lane) {
      const scenes::Bounds box =
          lane < children.size() ? binary_.nodes[children[lane]].box : scenes::Bounds{};  // empty
      node.set_box(lane, box);
    }
    for (std::uint32_t octant = 0; octant < node.orders.size(); ++octant) {
      node.orders[octant] = order_along(octant, node, children.size());
    }
    return node;
  }

  /// Returns the order for WideNode::orders: by the centers' positions along the octant's diagonal.
  static std::uint32_t order_along(std::uint32_t octant, const WideNode& node, std::size_t count) {
    std::array<float, kBvhLanes> places{};
    std::array<std::uint32_t, kBvhLanes> lanes{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool backward = (octant >> axis & 1U) != 0;
      for (std::size_t lane = 0; lane < kBvhLanes; ++lane) {
        const float twice_center = node.planes[axis][lane] + node.planes[axis + 3][lane];
        places[lane] += backward ? -twice_center : twice_center;
      }
    }
    for (std::uint32_t lane = 0; lane < kBvhLanes; ++lane) lanes[lane] = lane;
    // Insertion sort: std::stable_sort would allocate memory eight times for each node.
    for (std::size_t i = 1; i < count; ++i) {
      const std::uint32_t moved = lanes[i];
      std::size_t k = i;
      for (; k > 0 && places[moved] > places[lanes[k - 1]]; --k) lanes[k] = lanes[k - 1];
      lanes[k] = moved;
    }
    std::uint32_t order = 0;
    for (std::uint32_t i = 0; i < kBvhLanes; ++i) order |= lanes[i] << 3 * i;
    return order;
  }

  /// Makes a leaf of parts in order of id.
  ChildReference make_leaf(const scenes::Bounds& box, std::uint32_t first, std::uint32_t count) {
    ++wide_.leaves;
    const auto first_block = static_cast<std::uint32_t>(wide_.blocks.size());
    auto items = std::span(binary_.items).subspan(first, count);
    std::sort(items.begin(), items.end());
    // Pieces of a divided part may end up in the same leaf.
    items = items.first(
        static_cast<std::size_t>(std::unique(items.begin(), items.end()) - items.begin()));
    wide_.references += items.size();
    wide_.visits.add_leaf(box, static_cast<std::uint32_t>(items.size()));
    leaf_parts_.clear();
    for (const std::uint32_t item : items) leaf_parts_.push_back(parts_[item]);
    append_blocks(scene_, leaf_parts_, wide_.blocks);
    if (wide_.blocks.size() > ChildReference::kBlockIndices) {
      throw InputError(
          fmt::format("the hierarchy over '{}' needs more than {} leaf blocks; use a scene with "
                      "fewer primitives",
                      scene_.name, ChildReference::kBlockIndices));
    }
    return ChildReference::leaf(first_block,
                                static_cast<std::uint32_t>(wide_.blocks.size()) - first_block);
  }

  const scenes::Scene& scene_;
  std::vector<PrimitivePart> parts_;
  std::vector<PrimitivePart> leaf_parts_;  ///< parts of the leaf being made
  BinaryBvh binary_;
  std::optional<Collapse> collapse_;
  WideBvh wide_;
};

BinaryBvh build_binary_bvh(const scenes::Scene& scene, std::span<const PrimitivePart> parts,
                           BvhBuilder builder, const BvhOptions& options) {
  if (builder == BvhBuilder::kSpatial) {
    return build_spatial_bvh(scene, parts, overlap_tolerance(scene), options);
  }
  const std::vector<scenes::Bounds> boxes = padded_boxes(scene, parts);
  switch (builder) {
    case BvhBuilder::kLbvh:
      return build_lbvh(boxes, options);
    case BvhBuilder::kPloc:
      return build_ploc(boxes, options);
    case BvhBuilder::kSweep:
      return build_sweep_bvh(boxes, options);
    default:
      return build_bvh(boxes, options);
  }
}

}  // namespace

WideBvh build_wide_bvh(const scenes::Scene& scene, const WideBvhOptions& options) {
  const bool collapses = options.collapse == BvhCollapse::kCost;
  // Reinsertion can move more if leaves are small. They are merged afterward.
  const bool has_small_leaves = collapses || options.reinsertion;
  const BvhOptions splits = has_small_leaves ? before_collapse(options.splits) : options.splits;
  std::vector<PrimitivePart> parts = collect_parts(scene);
  BinaryBvh binary = build_binary_bvh(scene, parts, options.builder, splits);
  if (options.reinsertion) reinsert(binary, splits.parallel);
  if (options.reinsertion && !collapses) merge_leaves(binary, options.splits);
  const double cost = sah_cost(binary, options.splits);
  WideBvhBuilder builder(scene, std::move(parts), std::move(binary));
  if (collapses) builder.collapse(options.splits.max_leaf);
  WideBvh wide = builder.build();
  wide.cost = cost;
  return wide;
}

WideBvh widen_for_streams(const scenes::Scene& scene, std::vector<PrimitivePart> parts,
                          std::span<const scenes::Bounds> boxes, BinaryBvh binary, bool parallel) {
  BvhOptions splits = before_collapse({});
  splits.parallel = parallel;
  divide_leaves(binary, boxes, splits);
  WideBvhBuilder builder(scene, std::move(parts), std::move(binary));
  builder.collapse(splits.max_leaf);
  return builder.build();
}

}  // namespace beambench::accel::bvh
