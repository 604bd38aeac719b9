#include "accel/bvh/sweep_builder.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>

#include "accel/bvh/box_quads.hpp"
#include "accel/bvh/bvh_layout.hpp"
#include "accel/bvh/item_ranges.hpp"
#include "accel/bvh/object_split.hpp"
#include "accel/bvh/pending_node.hpp"
#include "accel/core/large_pages.hpp"
#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

float area_of(const QuadBox& box) {
  const Quad side = box.upper - box.lower;
  return side[0] * (side[1] + side[2]) + side[1] * side[2];
}

class SweepBuilder {
 public:
  SweepBuilder(std::span<const scenes::Bounds> boxes, const BvhOptions& options)
      : options_(options), is_left_(boxes.size()), spare_(boxes.size()), costs_(boxes.size()) {
    boxes_.reserve(boxes.size());
    for (const scenes::Bounds& box : boxes)
      boxes_.push_back({quad_of(box.lower), quad_of(box.upper)});
    for (std::size_t axis = 0; axis < 3; ++axis) sort_along(axis);
  }

  BinaryBvh build() {
    if (boxes_.empty()) return {};
    nodes_.resize(2 * boxes_.size() - 1);
    subdivide({0, 1, 0, boxes_.size(), 1});
    return laid_out(nodes_, order_[0]);
  }

 private:
  struct Split {
    float cost = std::numeric_limits<float>::infinity();
    std::size_t axis = 0;
    std::size_t middle = 0;   ///< the beginning of the right child's items
    std::size_t balance = 0;  ///< number of items of the smaller child
  };

  void sort_along(std::size_t axis) {
    std::vector<std::uint32_t>& order = order_[axis];
    order.resize(boxes_.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto center = [&](std::uint32_t item) {
      const QuadBox& box = boxes_[item];
      return box.lower[static_cast<int>(axis)] + box.upper[static_cast<int>(axis)];
    };
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      const float of_a = center(a);
      const float of_b = center(b);
      return of_a < of_b || (of_a == of_b && a < b);
    };
    if (options_.parallel) {
      tbb::parallel_sort(order.begin(), order.end(), before);
    } else {
      std::sort(order.begin(), order.end(), before);
    }
  }

  void subdivide(const PendingNode& pending) {
    BvhNode& node = nodes_[pending.node];
    QuadBox box = QuadBox::empty();
    for (std::size_t i = pending.begin; i < pending.end; ++i) box.include(boxes_[order_[0][i]]);
    node.box = box.bounds();
    const std::size_t middle = divide(pending, node.box);
    if (middle == pending.end) return pending.make_leaf(node);
    pending.make_interior(node);
    const PendingNode left = pending.left(middle);
    const PendingNode right = pending.right(middle);
    if (options_.parallel && pending.count() >= kParallelItems) {
      tbb::task_group_context mode = calling_mode();
      tbb::parallel_invoke([&] { subdivide(left); }, [&] { subdivide(right); }, mode);
    } else {
      subdivide(left);
      subdivide(right);
    }
  }

  /// Moves the left child's items to the front in all orders. Returns where the right child's items
  /// begin, or the end of all items for a leaf.
  std::size_t divide(const PendingNode& pending, const scenes::Bounds& box) {
    if (pending.count() == 1) return pending.end;
    Split split;
    if (pending.depth < kDeepestSahSplit) {
      for (std::size_t axis = 0; axis < 3; ++axis) sweep(pending, axis, split);
      if (leaf_pays(pending.count(), box, split.cost, options_)) return pending.end;
    } else {
      if (pending.count() <= options_.max_leaf) return pending.end;
      split.middle = pending.begin + pending.count() / 2;
    }
    partition(pending, split);
    return split.middle;
  }

  /// Replaces `best` by a better split across the axis.
  void sweep(const PendingNode& pending, std::size_t axis, Split& best) {
    const std::vector<std::uint32_t>& order = order_[axis];
    QuadBox right = QuadBox::empty();
    for (std::size_t i = pending.end - 1; i > pending.begin; --i) {
      right.include(boxes_[order[i]]);
      costs_[i] = area_of(right) * leaf_cost(static_cast<std::uint32_t>(pending.end - i), options_);
    }
    QuadBox left = QuadBox::empty();
    for (std::size_t i = pending.begin + 1; i < pending.end; ++i) {
      left.include(boxes_[order[i - 1]]);
      const auto left_count = static_cast<std::uint32_t>(i - pending.begin);
      const float cost = area_of(left) * leaf_cost(left_count, options_) + costs_[i];
      if (cost > best.cost) continue;
      const std::size_t balance = std::min(i - pending.begin, pending.end - i);
      if (cost == best.cost && balance <= best.balance) continue;
      best = {cost, axis, i, balance};
    }
  }

  void partition(const PendingNode& pending, const Split& split) {
    const auto at = [](auto& list, std::size_t i) {
      return list.begin() + static_cast<std::ptrdiff_t>(i);
    };
    for (std::size_t i = pending.begin; i < pending.end; ++i) {
      is_left_[order_[split.axis][i]] = i < split.middle ? 1 : 0;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis == split.axis) continue;
      std::vector<std::uint32_t>& order = order_[axis];
      std::size_t left = pending.begin;
      std::size_t right = pending.begin;  // in the spare array
      for (std::size_t i = pending.begin; i < pending.end; ++i) {
        const std::uint32_t item = order[i];
        (is_left_[item] != 0 ? order[left++] : spare_[right++]) = item;
      }
      std::copy(at(spare_, pending.begin), at(spare_, right), at(order, left));
    }
  }

  BvhOptions options_;
  LargePageVector<QuadBox> boxes_;
  std::array<std::vector<std::uint32_t>, 3> order_;  ///< items by center along each axis
  std::vector<std::uint8_t> is_left_;                ///< whether an item goes left
  std::vector<std::uint32_t> spare_;
  std::vector<float> costs_;  ///< costs of a child with the items from i on
  LargePageVector<BvhNode> nodes_;
};

}  // namespace

BinaryBvh build_sweep_bvh(std::span<const scenes::Bounds> boxes, const BvhOptions& options) {
  return SweepBuilder(boxes, options).build();
}

}  // namespace beambench::accel::bvh
