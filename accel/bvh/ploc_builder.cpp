#include "accel/bvh/ploc_builder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "accel/bvh/box_quads.hpp"
#include "accel/bvh/bvh_layout.hpp"
#include "accel/bvh/item_ranges.hpp"
#include "accel/bvh/morton_order.hpp"
#include "accel/core/large_pages.hpp"
#include "accel/core/padded_bounds.hpp"
#include "accel/core/unset_pages.hpp"

namespace beambench::accel::bvh {
namespace {

static_assert(kPlocRadius % 4 == 0, "neighbors are weighed four at a time");

/// Neighbors are merged instead in a round in which fewer than one cluster in `kFewMerge` would
/// merge.
constexpr std::size_t kFewMerge = 32;

/// A cluster's choice: the upper half holds the area of the common box, the lower half the
/// exclusive or of both positions. This orders pairs of equal area so that many equal boxes all
/// merge, and the pair with the lowest key always merges.
using Choice = std::uint64_t;

/// The clusters of a round. Coordinates are in separate arrays for SIMD, padded by a register.
struct Clusters {
  std::array<LargePageVector<float>, 6> planes;  ///< lower x, y, z; upper x, y, z
  UnsetLargePageVector<std::uint32_t> first;     ///< like BvhNode::first
  UnsetLargePageVector<std::uint32_t> count;
  std::size_t size = 0;

  explicit Clusters(std::size_t capacity) : first(capacity), count(capacity) {
    for (auto& plane : planes) plane.resize(capacity + kPlocRadius);
  }

  BvhNode node(std::size_t at) const {
    return {{{planes[0][at], planes[1][at], planes[2][at]},
             {planes[3][at], planes[4][at], planes[5][at]}},
            first[at],
            count[at]};
  }
  void put(std::size_t at, const BvhNode& node) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<std::size_t>(axis);
      planes[row][at] = node.box.lower[axis];
      planes[row + 3][at] = node.box.upper[axis];
    }
    first[at] = node.first;
    count[at] = node.count;
  }
};

Quad load(const float* from) {
  Quad quad;
  std::memcpy(&quad, from, sizeof quad);
  return quad;
}

class PlocBuilder {
 public:
  PlocBuilder(std::span<const scenes::Bounds> boxes, const BvhOptions& options)
      : boxes_(boxes), options_(options) {}

  BinaryBvh build() {
    if (boxes_.empty()) return {};
    Clusters now = first_clusters();
    Clusters next(now.size);
    nodes_.resize(1);
    while (now.size > 1) {
      choose(now);
      merge(now, next);
      std::swap(now, next);
    }
    nodes_[0] = now.node(0);
    return laid_out(nodes_, items_, next_item_);
  }

 private:
  Clusters first_clusters() {
    const UnsetLargePageVector<MortonKey> keys = morton_order(boxes_, options_.parallel);
    Clusters clusters(boxes_.size());
    clusters.size = boxes_.size();
    items_.resize(boxes_.size());
    next_item_.resize(boxes_.size());
    ItemRanges(boxes_.size(), options_.parallel)
        .for_each([&](std::size_t, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            const auto place = static_cast<std::uint32_t>(i);
            items_[i] = index_of(keys[i]);
            next_item_[i] = place;
            clusters.put(i, {boxes_[items_[i]], place, 1});
          }
        });
    return clusters;
  }

  void choose(const Clusters& clusters) {
    choices_.resize(clusters.size);
    ItemRanges(clusters.size, options_.parallel)
        .for_each(
            [&](std::size_t, std::size_t begin, std::size_t end) { choose(clusters, begin, end); });
  }

  /// Evaluates each pair once, or twice if its clusters are in different ranges.
  void choose(const Clusters& clusters, std::size_t begin, std::size_t end) {
    std::fill(choices_.begin() + static_cast<std::ptrdiff_t>(begin),
              choices_.begin() + static_cast<std::ptrdiff_t>(end),
              std::numeric_limits<Choice>::max());
    for (std::size_t i = begin - std::min(begin, kPlocRadius); i < end; ++i) {
      const std::size_t last = std::min(i + kPlocRadius, clusters.size - 1);
      Choice own = std::numeric_limits<Choice>::max();
      for (std::size_t j = i + 1; j <= last; j += 4) {
        const Quad areas = common_areas(clusters, i, j);
        const std::size_t pairs = std::min<std::size_t>(4, last + 1 - j);
        for (std::size_t lane = 0; lane < pairs; ++lane) {
          const std::size_t other = j + lane;
          const Choice choice = Choice{std::bit_cast<std::uint32_t>(areas[static_cast<int>(lane)])}
                                    << 32U |
                                (i ^ other);
          own = std::min(own, choice);
          if (other >= begin && other < end) choices_[other] = std::min(choices_[other], choice);
        }
      }
      if (i >= begin) choices_[i] = std::min(choices_[i], own);
    }
  }

  /// Returns half the areas of the boxes around cluster i and each of four others.
  static Quad common_areas(const Clusters& clusters, std::size_t i, std::size_t others) {
    std::array<Quad, 3> side;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& lower = clusters.planes[axis];
      const auto& upper = clusters.planes[axis + 3];
      side[axis] = larger(load(&upper[others]), quad_of(upper[i])) -
                   smaller(load(&lower[others]), quad_of(lower[i]));
    }
    return side[0] * (side[1] + side[2]) + side[1] * side[2];
  }

  /// Returns the cluster with which cluster i merges, or i if it stays alone.
  std::size_t partner_of(std::size_t i) const {
    const std::size_t other = i ^ (choices_[i] & 0xFFFFFFFFU);
    return choices_[other] == choices_[i] ? other : i;
  }

  /// The numbers of clusters and nodes that one range leaves.
  struct Left {
    std::size_t clusters = 0;
    std::size_t nodes = 0;
  };

  /// Counts the clusters and nodes that each range leaves, and returns the sum.
  Left count(const Clusters& now, const ItemRanges& ranges, std::vector<Left>& places) const {
    ranges.for_each([&](std::size_t range, std::size_t begin, std::size_t end) {
      Left left;
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t other = partner_of(i);
        if (other < i) continue;
        ++left.clusters;
        if (other > i && !becomes_leaf(now.node(i), now.node(other))) left.nodes += 2;
      }
      places[range] = left;
    });
    Left sum;
    for (const Left& left : places) {
      sum.clusters += left.clusters;
      sum.nodes += left.nodes;
    }
    return sum;
  }

  /// Merges neighbors, whatever they chose. For nested boxes, only one pair would merge per round,
  /// and there would be as many rounds as boxes.
  void pair_neighbors(std::size_t clusters) {
    for (std::size_t i = 0; i < clusters; ++i) choices_[i] = (i ^ 1U) < clusters ? 1 : 0;
  }

  void merge(const Clusters& now, Clusters& next) {
    const ItemRanges ranges(now.size, options_.parallel);
    std::vector<Left> places(ranges.count());
    Left sum = count(now, ranges, places);
    if (now.size - sum.clusters < now.size / kFewMerge) {
      pair_neighbors(now.size);
      sum = count(now, ranges, places);
    }
    next.size = sum.clusters;
    Left before{0, nodes_.size()};
    nodes_.resize(nodes_.size() + sum.nodes);
    for (Left& left : places) {
      before.clusters += std::exchange(left.clusters, before.clusters);
      before.nodes += std::exchange(left.nodes, before.nodes);
    }
    ranges.for_each([&](std::size_t range, std::size_t begin, std::size_t end) {
      Left at = places[range];
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t other = partner_of(i);
        if (other < i) continue;
        next.put(at.clusters++,
                 other == i ? now.node(i) : merged(now.node(i), now.node(other), at));
      }
    });
  }

  bool becomes_leaf(const BvhNode& a, const BvhNode& b) const {
    if (!a.is_leaf() || !b.is_leaf()) return false;
    const auto cost = [&](const BvhNode& leaf) {
      return static_cast<float>(half_area(leaf.box)) * leaf_cost(leaf.count, options_);
    };
    return leaf_pays(a.count + b.count, united(a.box, b.box), cost(a) + cost(b), options_);
  }

  /// Returns the merged cluster. Stores the children at `at.nodes`, or merges them into one leaf.
  BvhNode merged(const BvhNode& a, const BvhNode& b, Left& at) {
    const scenes::Bounds box = united(a.box, b.box);
    if (becomes_leaf(a, b)) {
      // Each ring of items is cut after its last item; the items of b follow those of a.
      std::swap(next_item_[a.first], next_item_[b.first]);
      return {box, b.first, a.count + b.count};
    }
    const auto children = static_cast<std::uint32_t>(at.nodes);
    nodes_[children] = a;
    nodes_[children + 1] = b;
    at.nodes += 2;
    return {box, children, 0};
  }

  std::span<const scenes::Bounds> boxes_;
  BvhOptions options_;
  std::vector<std::uint32_t> items_;      ///< sorted in Morton order
  std::vector<std::uint32_t> next_item_;  ///< the next item of the same leaf
  UnsetLargePageVector<Choice> choices_;
  UnsetLargePageVector<BvhNode> nodes_;  ///< the root, and pairs
};

}  // namespace

BinaryBvh build_ploc(std::span<const scenes::Bounds> boxes, const BvhOptions& options) {
  return PlocBuilder(boxes, options).build();
}

}  // namespace beambench::accel::bvh
