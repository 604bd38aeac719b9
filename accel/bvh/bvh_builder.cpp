#include "accel/bvh/bvh_builder.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include "accel/bvh/padded_bounds.hpp"

namespace beambench {
namespace {

constexpr std::size_t kBins = 32;

/// Of a few items fewer bins do: their sums would cost more than the items.
std::size_t bins_for(std::size_t items) { return std::min(kBins, 8 + items / 16); }

/// Below it nodes are split in the middle: 2^32 items then need 32 more levels.
constexpr std::uint32_t kDeepestSahSplit = kMaxBvhDepth - 34;
/// Where tasks would cost more than they bring.
constexpr std::size_t kParallelItems = 4096;

/// An item while it is sorted in place: its box stays near its neighbours'.
struct Item {
  Bounds box;
  std::uint32_t index;

  /// Twice the centre, which spares a multiplication.
  glm::vec3 center() const { return box.lower + box.upper; }
};

/// The boxes of some items, and the box of their centres.
struct Extent {
  Bounds boxes;
  Bounds centers;

  void include(const Item& item) {
    boxes.include(item.box);
    centers.include(item.center());
  }
  void include(const Extent& other) {
    boxes.include(other.boxes);
    centers.include(other.centers);
  }
};

struct Bin {
  Bounds box;
  std::uint32_t count = 0;

  void include(const Bin& other) {
    box.include(other.box);
    count += other.count;
  }
};

/// Maps centres to bins, on all axes.
class Binning {
 public:
  Binning(const Bounds& centers, std::size_t items)
      : lower_(centers.lower), count_(bins_for(items)) {
    const glm::vec3 extent = centers.extent();
    for (int axis = 0; axis < 3; ++axis) {
      scale_[axis] = extent[axis] > 0.0F ? static_cast<float>(count_) / extent[axis] : 0.0F;
      // An extent so small that its inverse overflows cannot be divided.
      if (!(scale_[axis] < std::numeric_limits<float>::max())) scale_[axis] = 0.0F;
    }
  }

  std::size_t count() const { return count_; }
  bool divides(int axis) const { return scale_[axis] > 0.0F; }
  std::size_t bin(const glm::vec3& center, int axis) const {
    const auto bin = static_cast<std::size_t>((center[axis] - lower_[axis]) * scale_[axis]);
    return std::min(bin, count_ - 1);
  }

 private:
  glm::vec3 lower_;
  std::size_t count_;
  glm::vec3 scale_{};
};

struct Bins {
  std::array<std::array<Bin, kBins>, 3> axis;

  void include(const Bins& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t i = 0; i < kBins; ++i) axis[a][i].include(other.axis[a][i]);
    }
  }
};

/// Items in a bin below `bin` go left.
struct Split {
  float cost = std::numeric_limits<float>::infinity();
  int axis = -1;  ///< none is worth it, or possible
  std::size_t bin = 0;
};

/// The cost of testing `count` items, block by block.
float leaf_cost(std::uint32_t count, const BvhOptions& options) {
  const std::uint32_t blocks = (count + options.block_size - 1) / options.block_size;
  return static_cast<float>(blocks);
}

class Builder {
 public:
  Builder(std::span<const Bounds> boxes, const BvhOptions& options) : options_(options) {
    items_.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) items_.push_back({boxes[i], i});
    if (!items_.empty()) nodes_.resize(2 * items_.size() - 1);
  }

  BinaryBvh build() {
    BinaryBvh bvh;
    if (items_.empty()) return bvh;
    subdivide({0, 1, 0, items_.size(), 1});
    compact(bvh);
    bvh.items.reserve(items_.size());
    for (const Item& item : items_) bvh.items.push_back(item.index);
    return bvh;
  }

 private:
  /// A node to be made of the items [begin, end). Nodes below it are taken from `free` on, where
  /// there is room for as many as can be: which task builds a node has no say in its number.
  struct Pending {
    std::size_t node;
    std::size_t free;
    std::size_t begin;
    std::size_t end;
    std::uint32_t depth;

    std::size_t count() const { return end - begin; }
  };

  void subdivide(const Pending& pending) {
    const Extent extent = measure(pending);
    BvhNode& node = nodes_[pending.node];
    node.box = extent.boxes;
    const std::size_t middle = pending.count() == 1 ? pending.end : partition(pending, extent);
    if (middle == pending.end) {
      node.first = static_cast<std::uint32_t>(pending.begin);
      node.count = static_cast<std::uint32_t>(pending.count());
      return;
    }
    node.first = static_cast<std::uint32_t>(pending.free);
    node.count = 0;
    const std::size_t left_nodes = 2 * (middle - pending.begin) - 2;  // below the left child
    const Pending left{pending.free, pending.free + 2, pending.begin, middle, pending.depth + 1};
    const Pending right{pending.free + 1, pending.free + 2 + left_nodes, middle, pending.end,
                        pending.depth + 1};
    if (options_.parallel && pending.count() >= kParallelItems) {
      tbb::parallel_invoke([&] { subdivide(left); }, [&] { subdivide(right); });
    } else {
      subdivide(left);
      subdivide(right);
    }
  }

  /// Sums up items, in parallel when asked: minima, maxima and counts are the same in any order.
  template <class Sum, class Add>
  Sum sum_up(const Pending& pending, const Add& add) const {
    const auto add_range = [&](std::size_t begin, std::size_t end, Sum& sum) {
      for (std::size_t i = begin; i < end; ++i) add(sum, items_[i]);
    };
    Sum sum;
    if (!options_.parallel || pending.count() < 8 * kParallelItems) {
      add_range(pending.begin, pending.end, sum);
      return sum;
    }
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(pending.begin, pending.end, kParallelItems), sum,
        [&](const auto& range, Sum part) {
          add_range(range.begin(), range.end(), part);
          return part;
        },
        [](Sum a, const Sum& b) {
          a.include(b);
          return a;
        });
  }

  Extent measure(const Pending& pending) const {
    return sum_up<Extent>(pending, [](Extent& extent, const Item& item) { extent.include(item); });
  }

  /// Moves the items of the left child to the front. Returns where the right child's begin, or the
  /// end for a leaf.
  std::size_t partition(const Pending& pending, const Extent& extent) {
    const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(pending.begin);
    const auto end = items_.begin() + static_cast<std::ptrdiff_t>(pending.end);
    if (pending.depth < kDeepestSahSplit) {
      const Binning binning(extent.centers, pending.count());
      const Split split = best_split(pending, binning, half_area(extent.boxes));
      if (split.axis >= 0) {
        const auto middle = std::partition(begin, end, [&](const Item& item) {
          return binning.bin(item.center(), split.axis) < split.bin;
        });
        return static_cast<std::size_t>(middle - items_.begin());
      }
    }
    if (pending.count() <= options_.max_leaf) return pending.end;
    return pending.begin + pending.count() / 2;
  }

  /// The cheapest split; none when a leaf is allowed and no dearer.
  Split best_split(const Pending& pending, const Binning& binning, double area) const {
    const Bins bins = sum_up<Bins>(pending, [&](Bins& sums, const Item& item) {
      const glm::vec3 center = item.center();
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin = sums.axis[static_cast<std::size_t>(axis)][binning.bin(center, axis)];
        bin.box.include(item.box);
        ++bin.count;
      }
    });
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!binning.divides(axis)) continue;
      sweep(std::span(bins.axis[static_cast<std::size_t>(axis)]).first(binning.count()), axis,
            best);
    }
    const auto whole = static_cast<float>(area);
    if (pending.count() <= options_.max_leaf &&
        whole * leaf_cost(static_cast<std::uint32_t>(pending.count()), options_) <=
            whole * options_.node_cost + best.cost) {
      best.axis = -1;
    }
    return best;
  }

  /// The costs of all splits along one axis.
  void sweep(std::span<const Bin> bins, int axis, Split& best) const {
    std::array<float, kBins> right_cost{};  // of the bins from i on
    std::array<std::uint32_t, kBins> right_count{};
    Bin right;
    for (std::size_t i = bins.size() - 1; i > 0; --i) {
      right.include(bins[i]);
      right_count[i] = right.count;
      right_cost[i] = static_cast<float>(half_area(right.box)) * leaf_cost(right.count, options_);
    }
    Bin left;
    for (std::size_t i = 1; i < bins.size(); ++i) {
      left.include(bins[i - 1]);
      if (left.count == 0 || right_count[i] == 0) continue;
      const float cost =
          static_cast<float>(half_area(left.box)) * leaf_cost(left.count, options_) + right_cost[i];
      if (cost < best.cost) best = {cost, axis, i};
    }
  }

  /// Copies the nodes in use, siblings together and each pair's children behind it.
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
  std::vector<Item> items_;
  std::vector<BvhNode> nodes_;
};

}  // namespace

BinaryBvh build_bvh(std::span<const Bounds> boxes, const BvhOptions& options) {
  return Builder(boxes, options).build();
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

}  // namespace beambench
