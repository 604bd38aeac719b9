#include "accel/bvh/bvh_layout.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "accel/bvh/object_split.hpp"
#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

class Layout {
 public:
  Layout(std::span<const BvhNode> nodes, std::span<const std::uint32_t> items,
         std::span<const std::uint32_t> next)
      : from_(nodes), items_(items), next_(next) {}

  BinaryBvh make() {
    if (from_.empty()) return {};
    bvh_.nodes.reserve(from_.size());
    bvh_.items.reserve(items_.size());
    bvh_.nodes.emplace_back();
    std::vector<Waiting> waiting{{0, 0, 1}};
    while (!waiting.empty()) {
      const Waiting now = waiting.back();
      waiting.pop_back();
      const BvhNode& node = from_[now.from];
      if (node.is_leaf()) {
        put_leaf(now.to, node, now.depth);
      } else if (now.depth >= kDeepestSahSplit) {
        divide(now.to, leaves_below(now.from), now.depth);
      } else {
        const std::uint32_t children = add_children(now.to);
        bvh_.nodes[now.to].box = node.box;
        waiting.push_back({node.first + 1, children + 1, now.depth + 1});
        waiting.push_back({node.first, children, now.depth + 1});
      }
    }
    return std::move(bvh_);
  }

 private:
  struct Waiting {
    std::uint32_t from;
    std::uint32_t to;
    std::uint32_t depth;
  };

  std::uint32_t add_children(std::uint32_t to) {
    const auto children = static_cast<std::uint32_t>(bvh_.nodes.size());
    bvh_.nodes[to].first = children;
    bvh_.nodes[to].count = 0;
    bvh_.nodes.resize(bvh_.nodes.size() + 2);
    return children;
  }

  void put_leaf(std::uint32_t to, const BvhNode& leaf, std::uint32_t depth) {
    bvh_.depth = std::max(bvh_.depth, depth);
    bvh_.nodes[to] = {leaf.box, static_cast<std::uint32_t>(bvh_.items.size()), leaf.count};
    std::uint32_t at = leaf.first;
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      at = next_.empty() ? leaf.first + i : next_[at];
      bvh_.items.push_back(items_[at]);
    }
  }

  /// Not recursive: a subtree may be as deep as its number of leaves.
  std::vector<std::uint32_t> leaves_below(std::uint32_t root) const {
    std::vector<std::uint32_t> leaves;
    std::vector<std::uint32_t> waiting{root};
    while (!waiting.empty()) {
      const std::uint32_t at = waiting.back();
      waiting.pop_back();
      if (from_[at].is_leaf()) {
        leaves.push_back(at);
        continue;
      }
      waiting.push_back(from_[at].first + 1);
      waiting.push_back(from_[at].first);
    }
    return leaves;
  }

  void divide(std::uint32_t to, std::span<const std::uint32_t> leaves, std::uint32_t depth) {
    if (leaves.size() == 1) return put_leaf(to, from_[leaves.front()], depth);
    const std::uint32_t children = add_children(to);
    const std::size_t middle = leaves.size() / 2;
    divide(children, leaves.first(middle), depth + 1);
    divide(children + 1, leaves.subspan(middle), depth + 1);
    bvh_.nodes[to].box = united(bvh_.nodes[children].box, bvh_.nodes[children + 1].box);
  }

  std::span<const BvhNode> from_;
  std::span<const std::uint32_t> items_;
  std::span<const std::uint32_t> next_;
  BinaryBvh bvh_;
};

}  // namespace

BinaryBvh laid_out(std::span<const BvhNode> nodes, std::span<const std::uint32_t> items,
                   std::span<const std::uint32_t> next) {
  return Layout(nodes, items, next).make();
}

void merge_leaves(BinaryBvh& bvh, const BvhOptions& options) {
  const auto cost = [&](const BvhNode& leaf) {
    return static_cast<float>(half_area(leaf.box)) * leaf_cost(leaf.count, options);
  };
  // Children come after their parents.
  for (std::size_t i = bvh.nodes.size(); i-- > 0;) {
    BvhNode& node = bvh.nodes[i];
    if (node.is_leaf()) continue;
    const BvhNode& left = bvh.nodes[node.first];
    const BvhNode& right = bvh.nodes[node.first + 1];
    if (!left.is_leaf() || !right.is_leaf()) continue;
    const std::uint32_t count = left.count + right.count;
    if (!leaf_pays(count, node.box, cost(left) + cost(right), options)) continue;
    node = {node.box, left.first, count};
  }
  bvh = laid_out(bvh.nodes, bvh.items);
}

}  // namespace beambench::accel::bvh
