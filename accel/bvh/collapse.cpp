#include "accel/bvh/collapse.hpp"

#include <algorithm>
#include <limits>

#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {

Collapse::Collapse(const BinaryBvh& bvh, const CollapseCosts& costs)
    : bvh_(bvh), plans_(bvh.nodes.size()) {
  // Children come after their parents.
  for (auto node = static_cast<std::uint32_t>(plans_.size()); node-- > 0;) plan(node, costs);
}

void Collapse::plan(std::uint32_t node, const CollapseCosts& costs) {
  const BvhNode& from = bvh_.nodes[node];
  Plan& plan = plans_[node];
  const auto area = static_cast<float>(half_area(from.box));
  const auto leaf_cost = [&] {
    const bool is_allowed = plan.count <= costs.max_leaf;
    return is_allowed ? area * (costs.leaf + costs.primitive * static_cast<float>(plan.count))
                      : std::numeric_limits<float>::infinity();
  };
  plan.roots.fill(0);
  if (from.is_leaf()) {
    plan.first = from.first;
    plan.count = from.count;
    plan.is_leaf = true;
    plan.cost.fill(area * (costs.leaf + costs.primitive * static_cast<float>(plan.count)));
    return;
  }
  const Plan& left = plans_[from.first];
  const Plan& right = plans_[from.first + 1];
  plan.first = left.first;
  plan.count = left.count + right.count;
  for (std::size_t roots = 2; roots <= kBvhLanes; ++roots) {
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t in_left = 1; in_left < roots; ++in_left) {
      const float cost = left.cost[in_left - 1] + right.cost[roots - in_left - 1];
      if (cost >= least) continue;
      least = cost;
      plan.roots[roots - 1] = static_cast<std::uint8_t>(in_left);
    }
    plan.cost[roots - 1] = least;
  }
  const float as_node = plan.cost[kBvhLanes - 1] + area * costs.node;
  const float as_leaf = leaf_cost();
  plan.is_leaf = as_leaf <= as_node;
  plan.cost[0] = std::min(as_leaf, as_node);
  for (std::size_t i = 1; i < kBvhLanes; ++i) {
    if (plan.cost[0] > plan.cost[i]) continue;
    plan.cost[i] = plan.cost[0];
    plan.roots[i] = 0;
  }
}

std::size_t Collapse::children_of(std::uint32_t node,
                                  std::array<std::uint32_t, kBvhLanes>& children) const {
  // Does not use `plan.roots`, which is 0 where one root costs no more, as for a node without area.
  std::size_t count = 0;
  const std::uint32_t left = bvh_.nodes[node].first;
  std::size_t in_left = 1;
  for (std::size_t i = 1; i < kBvhLanes; ++i) {
    const auto cost = [&](std::size_t roots) {
      return plans_[left].cost[roots - 1] + plans_[left + 1].cost[kBvhLanes - roots - 1];
    };
    if (cost(i) < cost(in_left)) in_left = i;
  }
  gather(left, in_left, children, count);
  gather(left + 1, kBvhLanes - in_left, children, count);
  return count;
}

void Collapse::gather(std::uint32_t node, std::size_t roots,
                      std::array<std::uint32_t, kBvhLanes>& children, std::size_t& count) const {
  const std::size_t in_left = plans_[node].roots[roots - 1];
  if (in_left == 0) {
    children[count++] = node;
    return;
  }
  const std::uint32_t left = bvh_.nodes[node].first;
  gather(left, in_left, children, count);
  gather(left + 1, roots - in_left, children, count);
}

}  // namespace beambench::accel::bvh
