// Builds an octree from the root down.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "accel/core/least_references.hpp"
#include "accel/octree/node_division.hpp"
#include "accel/octree/octree.hpp"

namespace beambench::accel::octree {

namespace {

/// A node about to be split.
struct Pending {
  std::uint32_t node;
  OctreeCell cell;

  Pending child(const glm::ivec3& split, std::uint32_t first_child, std::uint32_t octant) const {
    return {first_child + octant, cell.child(split, octant)};
  }
};

}  // namespace

/// Subdivides depth-first. Each level keeps the current lists of the eight children in one array,
/// so nothing is allocated for a node.
class OctreeBuilder {
 public:
  /// `part`, if given, must outlive the builder.
  OctreeBuilder(const scenes::Scene& scene, const OctreeOptions& options, Octree& octree,
                const OctreePart* part = nullptr)
      : scene_(scene),
        options_(options),
        division_(scene, options),
        octree_(octree),
        part_(part),
        limit_(limit()),
        lists_(static_cast<std::size_t>(options.max_level) + 1),
        octants_(static_cast<std::size_t>(options.max_level) + 1) {
    octree_.scene_bounds_ = scene.bounds;
  }

  void build() {
    if (part_ == nullptr) division_.require_few_references(options_.max_level, false);
    begin();
    auto& all = lists_[1];
    all.resize(scene_.primitives.size());
    std::iota(all.begin(), all.end(), scenes::PrimitiveId{0});
    subdivide(root(), all);
    finish();
  }

  void deepen(const Octree& coarser) {
    begin();
    subdivide_below(root(), coarser, 0);
    finish();
  }

 private:
  /// Returns the limit of references. If every occupied node is divided down to the finest cells,
  /// these predict the references; otherwise the references are estimated.
  ReferenceLimit limit() const {
    const std::uint64_t most = options_.max_references;
    if (part_ != nullptr) return ReferenceLimit(most);
    if (options_.max_objects == 0 && options_.planes == OctreeOptions::Planes::kMedian) {
      return {most, scene_, division_.grid()};
    }
    return {most, scene_, [this] { return division_.will_exceed(options_.max_level, false); }};
  }
  void begin() {
    octree_.grid_ = division_.grid();
    octree_.central_planes_ = options_.planes == OctreeOptions::Planes::kMedian;
    octree_.references_.reserve(scene_.primitives.size());
    octree_.nodes_.push_back({0, 0, 0});
  }
  Pending root() const { return {0, division_.root()}; }
  void finish() {
    octree_.nodes_.shrink_to_fit();
    octree_.splits_.shrink_to_fit();
    octree_.references_.shrink_to_fit();
  }

  /// Copies the division of the coarser octree. At its leaves, `subdivide` continues with their
  /// references.
  void subdivide_below(const Pending& pending, const Octree& coarser, std::uint32_t node) {
    const OctreeNode& there = coarser.nodes()[node];
    if (there.is_leaf()) {
      subdivide(pending, coarser.references(there));
      return;
    }
    const glm::ivec3 split =
        octree_.central_planes_ ? division_.split(pending.cell, {}) : coarser.split_of(there);
    const std::uint32_t first_child = make_interior(pending.node, split);
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      subdivide_below(pending.child(split, first_child, octant), coarser, there.first + octant);
    }
  }

  /// Makes a node interior and returns its first child.
  std::uint32_t make_interior(std::uint32_t node, const glm::ivec3& split) {
    const auto first_child = static_cast<std::uint32_t>(octree_.nodes_.size());
    octree_.nodes_.insert(octree_.nodes_.end(), 8, OctreeNode{node, 0, 0});
    octree_.nodes_[node].first = first_child;
    octree_.nodes_[node].count = OctreeNode::kInterior;
    if (!octree_.central_planes_) {
      octree_.splits_.push_back({static_cast<std::uint16_t>(split.x),
                                 static_cast<std::uint16_t>(split.y),
                                 static_cast<std::uint16_t>(split.z)});
    }
    return first_child;
  }

  void subdivide(const Pending& pending, std::span<const scenes::PrimitiveId> primitives) {
    const auto level = static_cast<std::size_t>(pending.cell.level);
    octree_.deepest_level_ = std::max(octree_.deepest_level_, pending.cell.level);
    if (is_foreign(pending)) primitives = {};
    if (!must_be_split(pending) && !division_.divides(pending.cell, primitives.size())) {
      make_leaf(pending.node, primitives);
      return;
    }
    const glm::ivec3 split = division_.split(pending.cell, primitives);
    const std::uint32_t first_child = make_interior(pending.node, split);
    const auto ends =
        division_.distribute(pending.cell, split, primitives, octants_[level], lists_[level + 1]);
    const auto& list = lists_[level + 1];
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      const std::size_t begin = octant == 0 ? 0 : ends[octant - 1];
      subdivide(pending.child(split, first_child, octant),
                std::span(list).subspan(begin, ends[octant] - begin));
    }
  }

  bool is_foreign(const Pending& pending) const {
    return part_ != nullptr && pending.cell.level == part_->level &&
           !part_->own(pending.cell.corner / pending.cell.size);
  }
  bool must_be_split(const Pending& pending) const {
    if (part_ == nullptr || pending.cell.level >= part_->level) return false;
    const std::int32_t size = 1 << (part_->level - pending.cell.level);
    return part_->divided(pending.cell.corner / pending.cell.size * size, size);
  }

  void make_leaf(std::uint32_t node, std::span<const scenes::PrimitiveId> primitives) {
    auto& references = octree_.references_;
    if (limit_.exceeded(references.size() + primitives.size())) {
      division_.fail_too_many_references();
    }
    octree_.nodes_[node].first = static_cast<std::uint32_t>(references.size());
    octree_.nodes_[node].count = static_cast<std::uint32_t>(primitives.size());
    references.insert(references.end(), primitives.begin(), primitives.end());
  }

  const scenes::Scene& scene_;
  const OctreeOptions& options_;
  NodeDivision division_;
  Octree& octree_;
  const OctreePart* part_;
  ReferenceLimit limit_;
  std::vector<std::vector<scenes::PrimitiveId>> lists_;  ///< one for each level
  std::vector<std::vector<std::uint8_t>> octants_;       ///< one for each level
};

Octree::Octree(const scenes::Scene& scene, const OctreeOptions& options) {
  OctreeBuilder(scene, options, *this).build();
}

Octree::Octree(const scenes::Scene& scene, const OctreeOptions& options, const Octree& coarser) {
  OctreeBuilder(scene, options, *this).deepen(coarser);
}

Octree::Octree(const scenes::Scene& scene, const OctreeOptions& options, const OctreePart& part) {
  OctreeBuilder(scene, options, *this, &part).build();
}

}  // namespace beambench::accel::octree
