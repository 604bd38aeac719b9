// Builds a kd-tree from the root down: events are sorted once, then passed to the children in
// sorted order.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "accel/bvh/clip.hpp"
#include "accel/core/expected_references.hpp"
#include "accel/core/least_references.hpp"
#include "accel/core/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/kd_tree/kd_tree.hpp"
#include "accel/kd_tree/plane_cost.hpp"
#include "accel/kd_tree/split_events.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::kd_tree {
namespace {

/// Return the largest float below a number and the smallest float above it.
float float_below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? rounded : -next_above(-rounded);
}
float float_above(double value) { return -float_below(-value); }

/// A splitting plane and its expected cost.
struct Split {
  int axis = -1;  ///< no axis
  float plane = 0.0F;
  double cost = std::numeric_limits<double>::infinity();
};

/// Wald and Havran's build in O(n log n) (2006, section 4.3). For each axis, one array holds the
/// events of the current node and of the pending upper children, so no memory is allocated per
/// node: the events of a node's lower child replace the node's own, and those of its upper child go
/// to the end.
///
/// An item begins at the largest float below its box, widened by the tolerance, and ends at the
/// smallest float above the widened box. It extends below a plane if it begins below the plane, and
/// above it if it ends above.
class Builder {
 public:
  Builder(const scenes::Scene& scene, const KdTreeOptions& options)
      : scene_(scene),
        options_(options),
        tolerance_(overlap_tolerance(scene)),
        pieces_(bvh::collect_parts(scene)),
        sides_(pieces_.size()),
        most_splits_(options.depth_for(pieces_.size())),
        most_references_(options.references_for(pieces_.size())),
        limit_(most_references_, scene, [this] { return will_exceed(); }) {}

  KdTree build() {
    tree_.scene_bounds = scene_.bounds;
    tree_.visits = ExpectedVisits(scene_.bounds);
    tree_.nodes.resize(2);
    if (pieces_.empty()) {
      tree_.leaves = tree_.empty_leaves = tree_.depth = 1;
      tree_.nodes[0] = KdNode::leaf(0, 0);
      return std::move(tree_);
    }
    if (pieces_.size() >= SplitEvent::kItems) {
      throw InputError(
          fmt::format("kd-tree: '{}' has {} triangles, spheres and cones; expected "
                      "fewer than {}: choose another structure",
                      scene_.name, pieces_.size(), SplitEvent::kItems));
    }
    // Hits lie within the tolerance of the bounds, so the root must contain that margin.
    tree_.root = padded(scene_.bounds, 2.0 * tolerance_);
    require_few_references();
    begin();
    subdivide(root());
    tree_.cost /= half_area(tree_.root);
    tree_.nodes.shrink_to_fit();
    tree_.blocks.shrink_to_fit();
    return std::move(tree_);
  }

 private:
  /// A node to be made, with its items: two events each, from `first_event` on in each list.
  struct Pending {
    std::uint32_t node;
    std::size_t first_event;
    std::uint32_t count;
    int splits;  ///< number of splits above it
    scenes::Bounds cell;

    std::size_t events() const { return std::size_t{2} * count; }
  };

  enum Side : std::uint8_t { kBelow, kAbove, kBoth };

  using EventLists = std::array<std::vector<SplitEvent>, 3>;

  Pending root() const { return {0, 0, static_cast<std::uint32_t>(pieces_.size()), 0, tree_.root}; }

  void begin() {
    const std::size_t count = 2 * pieces_.size();
    require_events(2 * count);
    for (std::uint32_t item = 0; item < pieces_.size(); ++item) {
      const scenes::Bounds bounds = bvh::part_bounds(scene_, pieces_[item]);
      for (int axis = 0; axis < 3; ++axis) {
        SplitEvent* const events = list(axis, std::size_t{2} * item);
        events[0] = SplitEvent::begin(float_below(bounds.lower[axis] - tolerance_), item);
        events[1] = SplitEvent::end(float_above(bounds.upper[axis] + tolerance_), item);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      sort_events({list(axis, 0), count}, {list(axis, count), count});
    }
    end_ = count;
  }

  SplitEvent* list(int axis, std::size_t first) {
    return events_[static_cast<std::size_t>(axis)].data() + first;
  }
  std::span<SplitEvent> list(int axis, const Pending& pending) {
    return {list(axis, pending.first_event), pending.events()};
  }
  /// Makes room for `count` events in each list.
  void require_events(std::size_t count) {
    if (count <= events_[0].size()) return;
    for (auto& events : events_) events.resize(count + count / 4);
  }

  void subdivide(const Pending& pending) {
    tree_.depth = std::max(tree_.depth, static_cast<std::uint32_t>(pending.splits) + 1);
    const Split split = best_split(pending);
    if (split.axis < 0) {
      make_leaf(pending);
      return;
    }
    if (tree_.nodes.size() + 2 > KdNode::kNodes) fail_too_many("nodes", KdNode::kNodes);
    const auto children = static_cast<std::uint32_t>(tree_.nodes.size());
    const KdNode node =
        KdNode::interior(static_cast<std::size_t>(split.axis), split.plane, children);
    tree_.nodes.resize(children + 2);
    tree_.nodes[pending.node] = node;
    tree_.cost += half_area(pending.cell);
    tree_.visits.add_node(pending.cell);

    const auto [below, above] = distribute(pending, split, node);
    end_ = above.first_event + above.events();
    subdivide(below);
    subdivide(above);
    end_ = above.first_event;
  }

  /// Creates a builder that makes estimates for some of another builder's items, with the same root
  /// and depth.
  Builder(const Builder& whole, std::vector<bvh::PrimitivePart> pieces)
      : scene_(whole.scene_),
        options_(whole.options_),
        tolerance_(whole.tolerance_),
        pieces_(std::move(pieces)),
        sides_(pieces_.size()),
        most_splits_(whole.most_splits_),
        most_references_(whole.most_references_),
        limit_(most_references_) {
    tree_.root = whole.tree_.root;
  }

  /// Returns an estimate of the references, which divides pending nodes with this builder.
  auto estimate() {
    struct Node {
      Pending place;
      EventLists events;
      std::size_t size() const { return place.count; }
    };
    begin();
    const auto taken = [this](const Pending& pending) {
      Node node{pending, {}};
      for (int axis = 0; axis < 3; ++axis) {
        const std::span<SplitEvent> events = list(axis, pending);
        node.events[static_cast<std::size_t>(axis)].assign(events.begin(), events.end());
      }
      return node;
    };
    const auto divide = [this, taken](const Node& node) -> std::optional<std::vector<Node>> {
      Pending pending = node.place;
      pending.first_event = 0;
      end_ = pending.events();
      for (int axis = 0; axis < 3; ++axis) {
        const auto& events = node.events[static_cast<std::size_t>(axis)];
        std::copy(events.begin(), events.end(), list(axis, 0));
      }
      const Split split = best_split(pending);
      if (split.axis < 0) return std::nullopt;
      std::vector<Node> children;
      const KdNode planes = KdNode::interior(static_cast<std::size_t>(split.axis), split.plane, 0);
      for (const Pending& child : distribute(pending, split, planes)) {
        if (child.count > 0) children.push_back(taken(child));
      }
      return children;
    };
    return ReferenceEstimate(taken(root()), divide);
  }

  /// Throws if a small part of the items shows that there will be too many references. Checks only
  /// spatial median planes.
  void require_few_references() const {
    if (options_.builder != KdTreeOptions::Builder::kMedian) return;
    const bool exceeds = part_surely_exceeds(
        most_references_, pieces_, [this](std::vector<bvh::PrimitivePart> pieces, Random& random) {
          Builder builder(*this, std::move(pieces));
          return builder.estimate()(random).leaves;
        });
    if (exceeds) fail_too_many("references", most_references_);
  }

  /// Predicts whether there will be too many references.
  bool will_exceed() const {
    Builder builder(*this, pieces_);
    auto estimate = builder.estimate();
    return surely_more_than(most_references_,
                            [&](Random& random) { return estimate(random).leaves; });
  }

  Split best_split(const Pending& pending) {
    if (pending.count <= options_.max_objects || pending.splits >= most_splits_) return {};
    if (options_.builder == KdTreeOptions::Builder::kMedian) return median(pending);
    Split best;
    best.cost = PlaneCost::leaf(pending.count, options_);  // a split must cost less
    for (int axis = 0; axis < 3; ++axis) sweep(pending, axis, best);
    return best;
  }

  /// Returns the middle of each axis in turn (Kaplan, "Space-tracing: a constant time ray-tracer",
  /// 1985), or no split if floats are too coarse.
  static Split median(const Pending& pending) {
    const int axis = pending.splits % 3;
    const double lower = pending.cell.lower[axis];
    const double upper = pending.cell.upper[axis];
    const auto middle = static_cast<float>(0.5 * (lower + upper));
    if (!(lower < middle && middle < upper)) return {};
    return {axis, middle, 0.0};
  }

  /// Compares the costs of all planes across an axis at which an item begins or ends. At one plane,
  /// all ends come before all beginnings. Between the ends and the beginnings, the counts are
  /// correct; before and after, they are too high, which is harmless.
  void sweep(const Pending& pending, int axis, Split& best) {
    const PlaneCost cost_of(pending.cell, axis, options_);
    std::uint32_t below = 0;
    std::uint32_t above = pending.count;
    for (const SplitEvent event : list(axis, pending)) {
      const std::uint32_t begins = event.is_begin() ? 1 : 0;
      above -= 1 - begins;
      const float plane = event.plane().plane();
      const double cost = cost_of(plane, below, above);
      if (cost < best.cost && cost_of.is_inside(plane)) best = {axis, plane, cost};
      below += begins;
    }
  }

  /// Distributes the items of a node to its children, and returns them.
  std::array<Pending, 2> distribute(const Pending& pending, const Split& split,
                                    const KdNode& node) {
    Pending below{node.children(), pending.first_event, 0, pending.splits + 1,
                  lower_cell(pending.cell, node)};
    Pending above{node.children() + 1, end_, 0, pending.splits + 1, upper_cell(pending.cell, node)};
    classify(pending, split);
    require_events(end_ + pending.events());
    for (auto& events : events_below_) events.clear();
    for (auto& events : events_above_) events.clear();
    for (const std::uint32_t item : straddling_) {
      clip_into(item, below.cell, events_below_);
      clip_into(item, above.cell, events_above_);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto slot = static_cast<std::size_t>(axis);
      const auto [kept_below, kept_above] = splice(pending, axis);
      merge(list(axis, below.first_event), kept_below, events_below_[slot]);
      merge(list(axis, above.first_event), kept_above, events_above_[slot]);
      below.count = static_cast<std::uint32_t>((kept_below + events_below_[slot].size()) / 2);
      above.count = static_cast<std::uint32_t>((kept_above + events_above_[slot].size()) / 2);
    }
    return {below, above};
  }

  /// Determines on which side of the plane each item is. An item begins before it ends.
  void classify(const Pending& pending, const Split& split) {
    straddling_.clear();
    const std::uint32_t plane = PlaneKey(split.plane).bits();
    for (const SplitEvent event : list(split.axis, pending)) {
      std::uint8_t& side = sides_[event.item()];
      const std::uint32_t at = event.plane().bits();
      if (event.is_begin()) {
        side = at >= plane ? kAbove : kBoth;
      } else if (at <= plane) {
        side = kBelow;
      } else if (side == kBoth) {
        straddling_.push_back(event.item());
      }
    }
  }

  /// Moves the events of items that are on only one side, in order: events of items below to the
  /// front of the node's list, those of items above to the end of the array. Returns how many it
  /// moved to each.
  std::array<std::size_t, 2> splice(const Pending& pending, int axis) {
    SplitEvent* const first = list(axis, pending.first_event);
    SplitEvent* to_below = first;
    SplitEvent* const first_above = list(axis, end_);
    SplitEvent* to_above = first_above;
    // Each event is written to both places, which is cheaper than branching on its destination.
    for (const SplitEvent event : list(axis, pending)) {
      const std::uint8_t side = sides_[event.item()];
      *to_below = event;
      *to_above = event;
      to_below += side == kBelow ? 1 : 0;
      to_above += side == kAbove ? 1 : 0;
    }
    return {static_cast<std::size_t>(to_below - first),
            static_cast<std::size_t>(to_above - first_above)};
  }

  /// Adds the events of an item's part in a cell, or none if the item does not overlap the cell.
  void clip_into(std::uint32_t item, const scenes::Bounds& cell, EventLists& lists) const {
    const Box wider{glm::dvec3(cell.lower) - tolerance_, glm::dvec3(cell.upper) + tolerance_};
    const auto part = options_.clip ? bvh::clipped_bounds(scene_, pieces_[item], wider)
                                    : bvh::whole_bounds(scene_, pieces_[item], wider);
    if (!part) return;
    for (int axis = 0; axis < 3; ++axis) {
      // The interval is within the cell, so that its planes are swept in order, and it is not
      // empty, even if the part lies entirely in the margin.
      const float lower = std::clamp(float_below(part->lower[axis] - tolerance_), cell.lower[axis],
                                     float_below(cell.upper[axis]));
      const float upper = std::clamp(float_above(part->upper[axis] + tolerance_),
                                     float_above(cell.lower[axis]), cell.upper[axis]);
      auto& events = lists[static_cast<std::size_t>(axis)];
      events.push_back(SplitEvent::begin(lower, item));
      events.push_back(SplitEvent::end(upper, item));
    }
  }

  /// Sorts `added` and merges it in place, from the back, into the sorted list of `count` events.
  static void merge(SplitEvent* events, std::size_t count, std::vector<SplitEvent>& added) {
    std::sort(added.begin(), added.end());
    std::size_t left = added.size();
    SplitEvent* to = events + count + left;
    while (left > 0) {
      *--to = count > 0 && added[left - 1] < events[count - 1] ? events[--count] : added[--left];
    }
  }

  void make_leaf(const Pending& pending) {
    ++tree_.leaves;
    if (pending.count == 0) ++tree_.empty_leaves;
    tree_.references += pending.count;
    if (limit_.exceeded(tree_.references)) {
      fail_too_many("references", most_references_);
    }
    leaf_items_.clear();
    for (const SplitEvent event : list(0, pending)) {
      if (event.is_begin()) leaf_items_.push_back(event.item());
    }
    std::sort(leaf_items_.begin(), leaf_items_.end());
    leaf_pieces_.clear();
    for (const std::uint32_t item : leaf_items_) leaf_pieces_.push_back(pieces_[item]);
    const std::size_t first = tree_.blocks.size();
    bvh::append_blocks(scene_, leaf_pieces_, tree_.blocks);
    const std::size_t blocks = tree_.blocks.size() - first;
    tree_.nodes[pending.node] =
        KdNode::leaf(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(blocks));
    tree_.cost += half_area(pending.cell) * static_cast<double>(blocks);
    tree_.visits.add_leaf(pending.cell, pending.count);
  }

  [[noreturn]] void fail_too_many(const char* what, std::uint64_t most) const {
    throw InputError(fmt::format(
        "the kd-tree over '{}' ({} primitives) holds more than {} {}; lower max_depth, raise "
        "max_objects{}, or raise max_references (up to 384 bytes each)",
        scene_.name, scene_.primitives.size(), most, what,
        options_.builder == KdTreeOptions::Builder::kSah ? " or traversal_cost" : ""));
  }

  const scenes::Scene& scene_;
  const KdTreeOptions& options_;
  double tolerance_;
  std::vector<bvh::PrimitivePart> pieces_;
  std::array<LargePageVector<SplitEvent>, 3> events_;  ///< events along each axis
  std::size_t end_ = 0;                                ///< end of the events in use
  std::vector<std::uint8_t> sides_;                    ///< each item's sides of the current split
  std::vector<std::uint32_t> straddling_;              ///< items on both sides of it
  EventLists events_below_;                            ///< events of the straddling items' parts
  EventLists events_above_;
  std::vector<std::uint32_t> leaf_items_;  ///< items of the leaf being made
  std::vector<bvh::PrimitivePart> leaf_pieces_;
  int most_splits_;
  std::uint64_t most_references_;
  ReferenceLimit limit_;
  KdTree tree_;
};

}  // namespace

KdTree build_kd_tree(const scenes::Scene& scene, const KdTreeOptions& options) {
  return Builder(scene, options).build();
}

}  // namespace beambench::accel::kd_tree
