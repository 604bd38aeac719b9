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

/// Estimates them from the nodes of a random part of the tree, which is divided level by level: of
/// more than 128 nodes of a level, as many are kept, each with a probability that its references
/// tell, and stand for the others. The mean over all random numbers is the number of references
/// (Knuth, "Estimating the efficiency of backtrack programs", Mathematics of Computation 29(129),
/// 1975, with one node of each level; more of them differ less).
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

/// Is the number that an estimate has as its mean more than that, as far as chance can tell? True
/// is returned of a number that is not with a probability below 4^-16 (one in four billion),
/// whatever the estimate: each of 16 must be above four times the limit, and by Markov's inequality
/// it is with a probability below 1/4. A number of little more than the limit is not told. The
/// random numbers are the same each time; of what fits, one estimate is made or few.
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
