#include "accel/bvh/reinsertion.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "accel/bvh/bvh_layout.hpp"
#include "accel/bvh/item_ranges.hpp"
#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

constexpr int kMaxRounds = 30;
/// The share of all nodes for which a round searches places.
constexpr double kShare = 0.3;
/// The last round is the first that reduces the areas of interior nodes by less than this share.
constexpr double kLeastGain = 0.0005;

/// A planned move: the node becomes the sibling of `to`.
struct Move {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  double gain = 0.0;  ///< area gained
};

/// The tree being improved. A pair of slots always holds two siblings.
class Reinsertion {
 public:
  Reinsertion(std::vector<BvhNode>& nodes, bool parallel)
      : nodes_(nodes), parallel_(parallel), parents_(nodes.size(), 0) {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) adopt_children(i);
  }

  void run() {
    for (int round = 0; round < kMaxRounds; ++round) {
      double whole = 0.0;
      for (const BvhNode& node : nodes_) whole += node.is_leaf() ? 0.0 : half_area(node.box);
      if (make_round() <= kLeastGain * whole) return;
    }
  }

 private:
  /// Siblings are at 1 and 2, 3 and 4, and so on.
  static std::uint32_t sibling_of(std::uint32_t node) { return ((node - 1) ^ 1U) + 1; }

  double area(std::uint32_t node) const { return half_area(nodes_[node].box); }
  double area_with(std::uint32_t node, const scenes::Bounds& box) const {
    return half_area(united(nodes_[node].box, box));
  }

  void adopt_children(std::uint32_t node) {
    if (nodes_[node].is_leaf()) return;
    parents_[nodes_[node].first] = parents_[nodes_[node].first + 1] = node;
  }

  /// Returns by how much the areas of interior nodes have decreased.
  double make_round() {
    std::vector<Move> moves;
    for (const std::uint32_t node : largest_nodes()) moves.push_back({node});
    const auto find = [&](std::size_t begin, std::size_t end) {
      std::vector<Candidate> waiting;
      for (std::size_t i = begin; i < end; ++i) moves[i] = best_move(moves[i].from, waiting);
    };
    if (parallel_) {
      tbb::task_group_context mode = calling_mode();
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, moves.size(), 64),
          [&](const auto& range) { find(range.begin(), range.end()); }, mode);
    } else {
      find(0, moves.size());
    }
    std::erase_if(moves, [](const Move& move) { return move.gain <= 0.0; });
    std::ranges::sort(moves, [](const Move& a, const Move& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.from < b.from;
    });
    double gain = 0.0;
    for (const Move& move : moves) gain += try_move(move);
    return gain;
  }

  /// Returns the nodes with the largest boxes, except the root and its children, which have no
  /// better place.
  std::vector<std::uint32_t> largest_nodes() const {
    struct Sized {
      float area;
      std::uint32_t node;
    };
    std::vector<Sized> sized;
    sized.reserve(nodes_.size());
    for (std::uint32_t i = 1; i < nodes_.size(); ++i) {
      if (parents_[i] != 0) sized.push_back({static_cast<float>(area(i)), i});
    }
    const auto count = std::min(
        sized.size(), static_cast<std::size_t>(kShare * static_cast<double>(sized.size())) + 64);
    const auto last = sized.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(sized.begin(), last, sized.end(), [](const Sized& a, const Sized& b) {
      return a.area != b.area ? a.area > b.area : a.node < b.node;
    });
    std::vector<std::uint32_t> nodes;
    for (auto at = sized.begin(); at != last; ++at) nodes.push_back(at->node);
    return nodes;
  }

  /// A subtree to search, with the gain if the new parent had no area.
  struct Candidate {
    double gain;
    std::uint32_t node;
  };

  /// Searches the subtrees of all siblings on the path to the root, except those where even a new
  /// parent as small as the node itself would gain less than the best place so far.
  Move best_move(std::uint32_t from, std::vector<Candidate>& waiting) const {
    Move best{from};
    const scenes::Bounds& box = nodes_[from].box;
    const double own = half_area(box);
    std::uint32_t pivot = parents_[from];
    scenes::Bounds rest = nodes_[sibling_of(from)].box;  // the rest of the pivot
    double removed = area(pivot);                        // area gained by taking the node out
    waiting.push_back({removed, sibling_of(from)});
    for (;;) {
      while (!waiting.empty()) {
        const Candidate candidate = waiting.back();
        waiting.pop_back();
        if (candidate.gain - own <= best.gain) continue;
        const double gain = candidate.gain - area_with(candidate.node, box);
        if (gain > best.gain) best = {from, candidate.node, gain};
        const BvhNode& node = nodes_[candidate.node];
        if (node.is_leaf()) continue;
        const double below = gain + half_area(node.box);
        waiting.push_back({below, node.first + 1});
        waiting.push_back({below, node.first});
      }
      if (pivot == 0) return best;
      waiting.push_back({removed, sibling_of(pivot)});
      rest.include(nodes_[sibling_of(pivot)].box);
      pivot = parents_[pivot];
      if (pivot != 0) removed += area(pivot) - half_area(rest);
    }
  }

  bool is_below(std::uint32_t node, std::uint32_t ancestor) const {
    for (; node != 0; node = parents_[node]) {
      if (node == ancestor) return true;
    }
    return false;
  }

  /// Makes a planned move if it still gains. Returns the gain, or 0 if the node stays where it is.
  double try_move(const Move& move) {
    const std::uint32_t parent = parents_[move.from];
    const std::uint32_t sibling = sibling_of(move.from);
    // Earlier moves may have changed the contents of these slots.
    if (move.to == parent || move.to == sibling || is_below(move.to, move.from)) return 0.0;
    const double gain = moved(move.from, move.to);
    if (gain > 0.0) return gain;
    moved(move.from, parent);  // where the sibling is now
    return 0.0;
  }

  /// Moves a node. Returns by how much the areas of interior nodes have decreased.
  double moved(std::uint32_t from, std::uint32_t to) {
    const std::uint32_t parent = parents_[from];
    const std::uint32_t sibling = sibling_of(from);
    double gain = area(parent);
    // The sibling takes the parent's place, the node at `to` takes the sibling's, and the parent
    // takes the place at `to`.
    const BvhNode old_sibling = nodes_[sibling];
    nodes_[sibling] = nodes_[to];
    nodes_[to].first = std::min(from, sibling);
    nodes_[to].count = 0;
    nodes_[parent] = old_sibling;
    for (const std::uint32_t changed : {sibling, to, parent}) adopt_children(changed);
    nodes_[to].box = united(nodes_[from].box, nodes_[sibling].box);
    gain -= area(to);
    gain += refit_above(to);
    gain += refit_above(parent);
    return gain;
  }

  double refit_above(std::uint32_t node) {
    double gain = 0.0;
    while (node != 0) {
      node = parents_[node];
      const std::uint32_t children = nodes_[node].first;
      const scenes::Bounds box = united(nodes_[children].box, nodes_[children + 1].box);
      if (box.lower == nodes_[node].box.lower && box.upper == nodes_[node].box.upper) break;
      gain += area(node) - half_area(box);
      nodes_[node].box = box;
    }
    return gain;
  }

  std::vector<BvhNode>& nodes_;
  bool parallel_;
  std::vector<std::uint32_t> parents_;
};

}  // namespace

void reinsert(BinaryBvh& bvh, bool parallel) {
  if (bvh.nodes.size() < 7) return;  // fewer than four leaves: no other place exists
  std::vector<BvhNode> nodes = bvh.nodes;
  Reinsertion(nodes, parallel).run();
  BinaryBvh better = laid_out(nodes, bvh.items);
  // If subtrees became too deep, rebuilding them may have cost more than was gained.
  if (sah_cost(better, {}) <= sah_cost(bvh, {})) bvh = std::move(better);
}

}  // namespace beambench::accel::bvh
