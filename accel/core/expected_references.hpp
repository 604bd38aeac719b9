#pragma once
// Estimates the references of a tree from a few of its nodes before it is built.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "scenes/base/random.hpp"

namespace beambench::accel {

/// The expected numbers of references of a tree.
struct ExpectedReferences {
  double leaves = 0.0;  ///< of all leaves
  double lists = 0.0;   ///< of all nodes except the root
};

/// Estimates the references of a tree from a random sample of its nodes, level by level. If a level
/// has more than 128 nodes, about 128 are sampled with a probability proportional to their
/// references and weighted accordingly. If the sample would have more than 16384 references, fewer
/// nodes are sampled, but at least 4, so that nodes that do not divide well do not take longer. The
/// estimate is unbiased (Knuth, "Estimating the efficiency of backtrack programs", Mathematics of
/// Computation 29(129), 1975, samples one node per level; sampling more nodes reduces the
/// variance). The levels above the first sampled level are the same in all estimates and are
/// divided only once. `Node::size()` is a node's number of references; `divide(node)` returns a
/// node's children that have references, or nullopt for a leaf.
template <class Node, class Divide>
class ReferenceEstimate {
 public:
  ReferenceEstimate(Node root, Divide divide) : divide_(std::move(divide)) {
    if (root.size() > 0) first_.add({std::move(root), 1.0});
    while (!first_.nodes.empty() && !first_.is_to_be_sampled()) first_ = below(first_, above_);
  }

  ExpectedReferences operator()(Random& random) {
    ExpectedReferences expected = above_;
    if (first_.nodes.empty()) return expected;
    Level level = sample(first_, random);
    while (!level.nodes.empty()) {
      level = below(level, expected);
      if (level.is_to_be_sampled()) level = sample(level, random);
    }
    return expected;
  }

 private:
  struct Kept {
    Node node;
    double weight;  ///< how many references each of its references represents
    double references() const { return weight * static_cast<double>(node.size()); }
  };
  struct Level {
    std::vector<Kept> nodes;
    double references = 0.0;  ///< weighted
    std::size_t listed = 0;   ///< not weighted

    void add(Kept kept) {
      references += kept.references();
      listed += kept.node.size();
      nodes.push_back(std::move(kept));
    }
    /// Returns how many nodes suffice.
    std::size_t sampled_nodes() const {
      constexpr std::size_t kReferences = std::size_t{1} << 14U;
      return std::clamp<std::size_t>(kReferences * nodes.size() / std::max<std::size_t>(listed, 1),
                                     4, 128);
    }
    bool is_to_be_sampled() const { return nodes.size() > sampled_nodes(); }
  };

  /// Returns the level below; adds the references of its nodes to `expected`.
  Level below(const Level& level, ExpectedReferences& expected) {
    Level next;
    for (const Kept& kept : level.nodes) {
      std::optional<std::vector<Node>> children = divide_(kept.node);
      if (!children) {
        expected.leaves += kept.references();
        continue;
      }
      for (Node& child : *children) next.add({std::move(child), kept.weight});
    }
    expected.lists += next.references;
    return next;
  }

  /// Keeps the nodes of references chosen at equal steps from a random first reference (systematic
  /// sampling).
  static Level sample(const Level& level, Random& random) {
    Level sampled;
    const double distance = level.references / static_cast<double>(level.sampled_nodes());
    double next = random.unit() * distance;
    double passed = 0.0;
    for (const Kept& kept : level.nodes) {
      passed += kept.references();
      double chosen = 0.0;
      for (; next < passed; next += distance) ++chosen;
      if (chosen == 0.0) continue;
      sampled.add({kept.node, chosen * distance / static_cast<double>(kept.node.size())});
    }
    return sampled;
  }

  Divide divide_;
  ExpectedReferences above_;  ///< of the levels above `first_`
  Level first_;               ///< the first sampled level; empty if no level needs sampling
};

/// Returns whether the expected value of a nonnegative estimate exceeds `most`. A false positive
/// has a probability below one in a million, whatever the distribution: if the expected value is at
/// most `most`, the running product of estimate / most has an expected value of at most 1, and the
/// probability that it ever exceeds 2^20 is below 2^-20 (Ville's inequality; Shafer, "Testing by
/// betting", Journal of the Royal Statistical Society A 184(2), 2021). If the estimates are twice
/// the limit, 20 of them suffice; estimates below 1.42 times the limit are not detected. The random
/// numbers are the same in each call. For values within the limit, one or a few estimates are made.
template <class Estimate>
bool surely_more_than(std::uint64_t most, Estimate estimate) {
  constexpr int kMaxEstimates = 40;
  constexpr double kEnough = 0x1p20;
  Random random(1);
  double product = 1.0;
  for (int i = 0; i < kMaxEstimates && product >= 1.0; ++i) {
    product *= estimate(random) / static_cast<double>(most);
    if (product > kEnough) return true;
  }
  return false;
}

/// A random subset of a list: one of each `stride` neighbors, so that it contains each member with
/// a probability of at most 1 / stride.
template <class T>
struct RandomPart {
  static constexpr std::size_t kMembers = 16;

  RandomPart(const std::vector<T>& list, Random& random)
      : stride(std::max<std::size_t>(list.size() / kMembers, 1)) {
    for (std::size_t first = 0; first + stride <= list.size(); first += stride) {
      members.push_back(list[first + random.below(stride)]);
    }
  }

  std::size_t stride;
  std::vector<T> members;
};

/// Predicts whether a tree over a list will have more than `most` references if its nodes are
/// divided at fixed planes while they refer to more than a given number of members. Longer lists do
/// not take longer: `references(members, random)` estimates the references of a tree over a random
/// subset of the list. That tree is the full one, except that some branches end earlier. So each
/// member has at least as many references in the full tree (or nearly: a leaf may refer to a member
/// that is in none of its smaller cells), and the expected number of the subset's references, times
/// `stride`, does not exceed the total. Returns false for short lists, which are quickly divided,
/// and possibly where a few members have most of the references.
template <class T, class References>
bool part_surely_exceeds(std::uint64_t most, const std::vector<T>& list, References references) {
  constexpr std::size_t kShort = 4096;
  if (list.size() < kShort) return false;
  return surely_more_than(most, [&](Random& random) {
    RandomPart<T> part(list, random);
    return static_cast<double>(part.stride) * references(std::move(part.members), random);
  });
}

}  // namespace beambench::accel
