#include "accel/bvh/bvh_builder.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include "accel/bvh/box_quads.hpp"
#include "accel/bvh/object_split.hpp"
#include "accel/bvh/pending_node.hpp"
#include "accel/core/large_pages.hpp"
#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

class Builder {
 public:
  Builder(std::span<const scenes::Bounds> boxes, const BvhOptions& options) : options_(options) {
    items_.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) items_.emplace_back(boxes[i], i);
    if (!items_.empty()) nodes_.resize(2 * items_.size() - 1);
  }

  BinaryBvh build() {
    BinaryBvh bvh;
    if (items_.empty()) return bvh;
    subdivide({{0, 1, 0, items_.size(), 1}, measure(0, items_.size())});
    compact(bvh);
    bvh.items.reserve(items_.size());
    for (const BuildItem& item : items_) bvh.items.push_back(item.index());
    return bvh;
  }

 private:
  struct Pending : PendingNode {
    BuildExtent extent;  ///< the extent of the items
  };

  /// The beginning of the right child's items, and the extents of both children.
  struct Halves {
    std::size_t middle;
    BuildExtent left;
    BuildExtent right;
  };

  void subdivide(const Pending& pending) {
    BvhNode& node = nodes_[pending.node];
    node.box = pending.extent.boxes.bounds();
    const std::optional<Halves> halves = halve(pending);
    if (!halves) return pending.make_leaf(node);
    pending.make_interior(node);
    const Pending left{pending.left(halves->middle), halves->left};
    const Pending right{pending.right(halves->middle), halves->right};
    if (options_.parallel && pending.count() >= kParallelItems) {
      tbb::parallel_invoke([&] { subdivide(left); }, [&] { subdivide(right); });
    } else {
      subdivide(left);
      subdivide(right);
    }
  }

  BuildExtent measure(std::size_t begin, std::size_t end) const {
    return sum_up(begin, end, [] { return BuildExtent(); });
  }

  /// Accumulates items, starting from `nothing()`, in parallel if requested. The result does not
  /// depend on the order, because it consists of minima, maxima and counts.
  template <class Nothing>
  std::invoke_result_t<Nothing> sum_up(std::size_t begin, std::size_t end,
                                       const Nothing& nothing) const {
    using Sum = std::invoke_result_t<Nothing>;
    const auto add_range = [&](std::size_t from, std::size_t to, Sum& sum) {
      for (std::size_t i = from; i < to; ++i) sum.include(items_[i]);
    };
    if (!options_.parallel || end - begin < 8 * kParallelItems) {
      Sum sum = nothing();
      add_range(begin, end, sum);
      return sum;
    }
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(begin, end, kParallelItems), nothing(),
        [&](const auto& range, Sum part) {
          add_range(range.begin(), range.end(), part);
          return part;
        },
        [](Sum a, const Sum& b) {
          a.include(b);
          return a;
        });
  }

  /// Moves the items of the left child to the front; returns nothing for a leaf.
  std::optional<Halves> halve(const Pending& pending) {
    if (pending.count() == 1) return std::nullopt;
    if (pending.depth < kDeepestSahSplit) {
      const Binning binning(pending.extent.centers, pending.count());
      const ObjectSplit split = best_split(pending, binning);
      if (split.axis >= 0) return partition(pending, binning, split);
    }
    if (pending.count() <= options_.max_leaf) return std::nullopt;
    const std::size_t middle = pending.begin + pending.count() / 2;
    return Halves{middle, measure(pending.begin, middle), measure(middle, pending.end)};
  }

  /// Works from both ends to the middle, like std::partition, but also accumulates the extents.
  Halves partition(const Pending& pending, const Binning& binning, const ObjectSplit& split) {
    Halves halves{pending.begin, {}, {}};
    std::size_t end = pending.end;
    const auto goes_left = [&](const BuildItem& item) {
      return binning.bins(item.center())[split.axis] < split.bin;
    };
    for (;;) {
      for (; halves.middle < end && goes_left(items_[halves.middle]); ++halves.middle) {
        halves.left.include(items_[halves.middle]);
      }
      if (halves.middle == end) return halves;
      halves.right.include(items_[halves.middle]);
      for (--end; halves.middle < end && !goes_left(items_[end]); --end) {
        halves.right.include(items_[end]);
      }
      if (halves.middle == end) return halves;
      std::swap(items_[halves.middle], items_[end]);
      halves.left.include(items_[halves.middle++]);
    }
  }

  /// Returns the cheapest split, or an empty one if a leaf is allowed and costs no more.
  ObjectSplit best_split(const Pending& pending, const Binning& binning) const {
    const Bins bins = sum_up(pending.begin, pending.end, [&] { return Bins(binning); });
    ObjectSplit best = best_object_split(bins, binning, options_);
    if (leaf_pays(pending.count(), pending.extent.boxes.bounds(), best.cost, options_)) {
      best.axis = -1;
    }
    return best;
  }

  /// Copies the nodes in use, with siblings together and each pair's children after it.
  void compact(BinaryBvh& bvh) const {
    struct Copied {
      std::uint32_t node;
      std::uint32_t depth;
    };
    bvh.nodes.push_back(nodes_[0]);
    std::vector<Copied> waiting{{0, 1}};
    while (!waiting.empty()) {
      const Copied copied = waiting.back();
      waiting.pop_back();
      bvh.depth = std::max(bvh.depth, copied.depth);
      if (bvh.nodes[copied.node].is_leaf()) continue;
      const std::size_t first = bvh.nodes[copied.node].first;
      const auto children = static_cast<std::uint32_t>(bvh.nodes.size());
      bvh.nodes[copied.node].first = children;
      bvh.nodes.push_back(nodes_[first]);
      bvh.nodes.push_back(nodes_[first + 1]);
      waiting.push_back({children + 1, copied.depth + 1});
      waiting.push_back({children, copied.depth + 1});
    }
  }

  BvhOptions options_;
  LargePageVector<BuildItem> items_;
  LargePageVector<BvhNode> nodes_;
};

}  // namespace

BinaryBvh build_bvh(std::span<const scenes::Bounds> boxes, const BvhOptions& options) {
  return Builder(boxes, options).build();
}

void divide_leaves(BinaryBvh& bvh, std::span<const scenes::Bounds> boxes,
                   const BvhOptions& options) {
  std::vector<std::uint32_t> leaves;
  std::vector<std::uint32_t> depths(bvh.nodes.size(), 1);
  for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    if (!node.is_leaf()) {
      depths[node.first] = depths[node.first + 1] = depths[i] + 1;
    } else if (node.count > 1) {
      leaves.push_back(i);
    }
  }
  BvhOptions serial = options;
  serial.parallel = false;
  std::vector<BinaryBvh> below(leaves.size());
  const auto build_below = [&](std::size_t i) {
    const BvhNode& leaf = bvh.nodes[leaves[i]];
    std::vector<scenes::Bounds> own;
    own.reserve(leaf.count);
    for (std::uint32_t k = 0; k < leaf.count; ++k) own.push_back(boxes[bvh.items[leaf.first + k]]);
    below[i] = build_bvh(own, serial);
    for (std::uint32_t& item : below[i].items) item = bvh.items[leaf.first + item];
  };
  if (options.parallel) {
    tbb::parallel_for(std::size_t{0}, leaves.size(), build_below);
  } else {
    for (std::size_t i = 0; i < leaves.size(); ++i) build_below(i);
  }
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const std::uint32_t depth = depths[leaves[i]] + below[i].depth - 1;
    if (depth > kMaxBvhDepth) continue;
    bvh.depth = std::max(bvh.depth, depth);
    const std::uint32_t items = bvh.nodes[leaves[i]].first;
    const auto nodes = static_cast<std::uint32_t>(bvh.nodes.size()) - 1;  // the first is the leaf's
    std::ranges::copy(below[i].items, bvh.items.begin() + items);
    for (BvhNode& node : below[i].nodes) node.first += node.is_leaf() ? items : nodes;
    bvh.nodes[leaves[i]] = below[i].nodes.front();
    bvh.nodes.insert(bvh.nodes.end(), below[i].nodes.begin() + 1, below[i].nodes.end());
  }
}

double sah_cost(const BinaryBvh& bvh, const BvhOptions& options) {
  double cost = 0.0;
  for (const BvhNode& node : bvh.nodes) {
    const float weight = node.is_leaf() ? leaf_cost(node.count, options) : options.node_cost;
    cost += half_area(node.box) * weight;
  }
  return bvh.nodes.empty() ? 0.0 : cost / half_area(bvh.nodes.front().box);
}

std::size_t gather_children(const BinaryBvh& bvh, std::uint32_t node,
                            std::span<std::uint32_t> children) {
  children[0] = bvh.nodes[node].first;
  children[1] = children[0] + 1;
  std::size_t count = 2;
  while (count < children.size()) {
    std::size_t largest = count;
    double largest_area = -1.0;
    for (std::size_t i = 0; i < count; ++i) {
      const BvhNode& child = bvh.nodes[children[i]];
      const double area = half_area(child.box);
      if (!child.is_leaf() && area > largest_area) {
        largest_area = area;
        largest = i;
      }
    }
    if (largest == count) break;
    const std::uint32_t first = bvh.nodes[children[largest]].first;
    children[largest] = first;
    children[count++] = first + 1;
  }
  return count;
}

}  // namespace beambench::accel::bvh
