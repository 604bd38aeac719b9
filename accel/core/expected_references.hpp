#pragma once
// The references of a tree that is not made yet, from a few of its nodes.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "scenes/core/random.hpp"

namespace beambench::accel {

/// What the nodes of a tree refer to.
struct ExpectedReferences {
  double leaves = 0.0;  ///< of all leaves
  double lists = 0.0;   ///< of all nodes but the root
};

/// Estimates them from a random sample of the tree's nodes, level by level: of more than 128 nodes
/// of a level, about 128 are sampled with a probability proportional to their references, and are
/// weighted accordingly. The estimate is unbiased (Knuth, "Estimating the efficiency of backtrack
/// programs", Mathematics of Computation 29(129), 1975, who samples one node of each level; more of
/// them have less variance).
/// `Node` has `size()`, its references; `divide(node)` returns those children of a node that refer
/// to something, or nullopt where it is a leaf.
template <class Node, class Divide>
ExpectedReferences expected_references(Node root, Divide divide, Random& random) {
  constexpr std::size_t kNodes = 128;
  struct Kept {
    Node node;
    double weight;  ///< what each of its references stands for
    double references() const { return weight * static_cast<double>(node.size()); }
  };
  ExpectedReferences expected;
  std::vector<Kept> level;
  if (root.size() > 0) level.push_back({std::move(root), 1.0});
  while (!level.empty()) {
    std::vector<Kept> below;
    double references = 0.0;
    for (const Kept& kept : level) {
      std::optional<std::vector<Node>> children = divide(kept.node);
      if (!children) {
        expected.leaves += kept.references();
        continue;
      }
      for (Node& child : *children) {
        below.push_back({std::move(child), kept.weight});
        references += below.back().references();
      }
    }
    expected.lists += references;
    if (below.size() > kNodes) {
      // Each of as many references at equal distances chooses its node, one of them at random.
      const double distance = references / static_cast<double>(kNodes);
      double next = random.unit() * distance;
      double passed = 0.0;
      std::size_t end = 0;
      for (Kept& kept : below) {
        passed += kept.references();
        double chosen = 0.0;
        for (; next < passed; next += distance) ++chosen;
        if (chosen == 0.0) continue;
        kept.weight = chosen * distance / static_cast<double>(kept.node.size());
        if (&kept != &below[end]) below[end] = std::move(kept);
        ++end;
      }
      below.erase(below.begin() + static_cast<std::ptrdiff_t>(end), below.end());
    }
    level = std::move(below);
  }
  return expected;
}

/// Does the expected value of an unbiased, nonnegative estimate exceed `most`? A false positive has
/// a probability below 4^-16 (one in four billion), whatever the distribution: each of 16 estimates
/// must exceed four times the limit, which by Markov's inequality has a probability below 1/4. An
/// excess below that factor is not detected. The random numbers are the same each time; where the
/// limit is kept, one estimate is made or few.
template <class Estimate>
bool surely_more_than(std::uint64_t most, Estimate estimate) {
  constexpr int kEstimates = 16;
  constexpr double kMargin = 4.0;
  Random random(1);
  for (int i = 0; i < kEstimates; ++i) {
    if (estimate(random) <= kMargin * static_cast<double>(most)) return false;
  }
  return true;
}

}  // namespace beambench::accel
