#include "accel/bvh/lbvh_builder.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include <tbb/parallel_for.h>

#include "accel/bvh/item_ranges.hpp"
#include "accel/bvh/morton_order.hpp"
#include "accel/bvh/object_split.hpp"
#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

class LbvhBuilder {
 public:
  LbvhBuilder(std::span<const scenes::Bounds> boxes, const BvhOptions& options)
      : boxes_(boxes), options_(options), keys_(morton_order(boxes, options.parallel)) {}

  BinaryBvh build() {
    BinaryBvh bvh;
    if (keys_.empty()) return bvh;
    if (options_.parallel) build_parts();
    Subtree whole;
    whole.nodes.reserve(keys_.size() / 2);
    whole.nodes.emplace_back();
    add(whole, 0, {0, keys_.size()}, 1);
    bvh.nodes = std::move(whole.nodes);
    bvh.depth = whole.depth;
    bvh.items.reserve(keys_.size());
    for (const MortonKey key : keys_) bvh.items.push_back(index_of(key));
    return bvh;
  }

 private:
  /// A range of the sorted items.
  struct Range {
    std::size_t begin;
    std::size_t end;

    std::size_t count() const { return end - begin; }
  };

  struct Subtree {
    std::vector<BvhNode> nodes;  ///< the root first
    std::uint32_t depth = 0;     ///< depth of the deepest leaf
    float cost = 0.0F;           ///< cost of the root, as `add` returns it
  };

  /// Ranges of equal codes are at most 30 levels deep and are halved from there on, so
  /// `kMaxBvhDepth` cannot be exceeded.
  std::size_t middle_of(const Range& range) const {
    const std::uint32_t first = code_of(keys_[range.begin]);
    const std::uint32_t differing = first ^ code_of(keys_[range.end - 1]);
    if (differing == 0) return range.begin + range.count() / 2;
    const std::uint32_t bit = std::bit_floor(differing);
    const auto begin = keys_.begin();
    const auto found =
        std::partition_point(begin + static_cast<std::ptrdiff_t>(range.begin),
                             begin + static_cast<std::ptrdiff_t>(range.end),
                             [&](MortonKey key) { return (code_of(key) & bit) == 0; });
    return static_cast<std::size_t>(found - begin);
  }

  /// Builds the subtrees of ranges that are small enough for one task; `add` then uses them.
  void build_parts() {
    std::vector<Range> ranges;
    std::vector<std::uint32_t> depths;
    collect_parts({0, keys_.size()}, 1, ranges, depths);
    std::vector<Subtree> parts(ranges.size());
    tbb::task_group_context mode = calling_mode();
    tbb::parallel_for(
        std::size_t{0}, parts.size(),
        [&](std::size_t i) {
          parts[i].nodes.emplace_back();
          parts[i].cost = add(parts[i], 0, ranges[i], depths[i]);
        },
        mode);
    parts_ = std::move(parts);
  }

  void collect_parts(const Range& range, std::uint32_t depth, std::vector<Range>& ranges,
                     std::vector<std::uint32_t>& depths) const {
    if (range.count() < kParallelItems) {
      ranges.push_back(range);
      depths.push_back(depth);
      return;
    }
    const std::size_t middle = middle_of(range);
    collect_parts({range.begin, middle}, depth + 1, ranges, depths);
    collect_parts({middle, range.end}, depth + 1, ranges, depths);
  }

  /// Makes `node` and its subtree from a range. Returns the cost, not divided by the area of the
  /// root.
  float add(Subtree& tree, std::uint32_t node, const Range& range, std::uint32_t depth) {
    if (range.count() < kParallelItems && taken_ < parts_.size()) {
      return take(tree, node, parts_[taken_++]);
    }
    const auto count = static_cast<std::uint32_t>(range.count());
    const auto make_leaf = [&](const scenes::Bounds& box) {
      tree.nodes[node] = {box, static_cast<std::uint32_t>(range.begin), count};
      tree.depth = std::max(tree.depth, depth);
      return static_cast<float>(half_area(box)) * leaf_cost(count, options_);
    };
    // If a leaf costs no more than the node alone, the node's subtree need not be considered.
    const bool may_be_leaf = count <= options_.max_leaf;
    if (count == 1 || (may_be_leaf && leaf_cost(count, options_) <= options_.node_cost)) {
      scenes::Bounds box;
      for (std::size_t i = range.begin; i < range.end; ++i) box.include(boxes_[index_of(keys_[i])]);
      return make_leaf(box);
    }
    const std::size_t middle = middle_of(range);
    const auto children = static_cast<std::uint32_t>(tree.nodes.size());
    tree.nodes.resize(tree.nodes.size() + 2);
    const std::uint32_t depth_before = tree.depth;
    const float left = add(tree, children, {range.begin, middle}, depth + 1);
    const float right = add(tree, children + 1, {middle, range.end}, depth + 1);
    const scenes::Bounds box = united(tree.nodes[children].box, tree.nodes[children + 1].box);
    if (may_be_leaf && leaf_pays(count, box, left + right, options_)) {
      tree.nodes.resize(children);
      tree.depth = depth_before;
      return make_leaf(box);
    }
    tree.nodes[node] = {box, children, 0};
    return static_cast<float>(half_area(box)) * options_.node_cost + left + right;
  }

  static float take(Subtree& tree, std::uint32_t node, const Subtree& part) {
    const auto offset = static_cast<std::uint32_t>(tree.nodes.size()) - 1;  // the first is `node`
    tree.nodes.insert(tree.nodes.end(), part.nodes.begin() + 1, part.nodes.end());
    tree.nodes[node] = part.nodes.front();
    const auto shift = [&](BvhNode& moved) {
      if (!moved.is_leaf()) moved.first += offset;
    };
    shift(tree.nodes[node]);
    std::for_each(tree.nodes.begin() + offset + 1, tree.nodes.end(), shift);
    tree.depth = std::max(tree.depth, part.depth);
    return part.cost;
  }

  std::span<const scenes::Bounds> boxes_;
  BvhOptions options_;
  UnsetLargePageVector<MortonKey> keys_;
  std::vector<Subtree> parts_;  ///< ordered as `add` takes them
  std::size_t taken_ = 0;
};

}  // namespace

BinaryBvh build_lbvh(std::span<const scenes::Bounds> boxes, const BvhOptions& options) {
  return LbvhBuilder(boxes, options).build();
}

}  // namespace beambench::accel::bvh
