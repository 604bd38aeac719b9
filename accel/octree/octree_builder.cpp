// Builds an octree from the root down.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "accel/core/tolerance.hpp"
#include "accel/octree/octree.hpp"
#include "scenes/core/error.hpp"

namespace beambench::accel::octree {

namespace {

/// A node about to be split: where it is, and its primitives.
struct Pending {
  std::uint32_t node;
  int level;
  glm::ivec3 corner;
  std::int32_t size;  ///< in finest cells per axis
};

}  // namespace

CellGrid octree_grid(const scenes::Scene& scene, const OctreeOptions& options) {
  const double tolerance = overlap_tolerance(scene);
  glm::dvec3 size(0.0);
  if (!scene.bounds.empty()) size = glm::dvec3(scene.bounds.upper) - glm::dvec3(scene.bounds.lower);
  if (options.root == OctreeOptions::Root::kCube) {
    size = glm::dvec3(std::max({size.x, size.y, size.z}));
  }
  // Hits lie within the tolerance of the bounds: the root must hold them.
  const glm::dvec3 margin = glm::max(size * options.pad, glm::dvec3(2.0 * tolerance));
  return make_cell_grid(scene.bounds, size, margin, glm::ivec3(1 << (options.max_level - 1)));
}

/// Depth-first subdivision. Each level keeps the lists of the eight children being worked on in one
/// array, so nothing is allocated for a node.
class OctreeBuilder {
 public:
  /// `part`, if given, outlives the builder.
  OctreeBuilder(const scenes::Scene& scene, const OctreeOptions& options, Octree& octree,
                const OctreePart* part = nullptr)
      : scene_(scene),
        options_(options),
        octree_(octree),
        part_(part),
        tolerance_(overlap_tolerance(scene)),
        lists_(static_cast<std::size_t>(options.max_level) + 1),
        octants_(static_cast<std::size_t>(options.max_level) + 1) {}

  void build() {
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
  void begin() {
    octree_.grid_ = octree_grid(scene_, options_);
    const auto count = static_cast<scenes::PrimitiveId>(scene_.primitives.size());
    ranges_.reserve(count);
    for (scenes::PrimitiveId id = 0; id < count; ++id) {
      ranges_.push_back(
          cell_range(octree_.grid_, scenes::primitive_bounds(scene_, id), tolerance_));
    }
    octree_.references_.reserve(count);
    octree_.nodes_.push_back({0, 0, 0});
  }
  Pending root() const { return {0, 1, glm::ivec3(0), octree_.grid_.cells.x}; }
  void finish() {
    octree_.nodes_.shrink_to_fit();
    octree_.references_.shrink_to_fit();
  }

  /// Where the coarser octree has a leaf, `subdivide` continues with its references.
  void subdivide_below(const Pending& pending, const Octree& coarser, std::uint32_t node) {
    const OctreeNode& there = coarser.nodes()[node];
    if (there.is_leaf()) {
      subdivide(pending, coarser.references(there));
      return;
    }
    const std::uint32_t first_child = split(pending.node);
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      subdivide_below(child_of(pending, first_child, octant), coarser, there.first + octant);
    }
  }

  /// Makes a node interior; returns its first child.
  std::uint32_t split(std::uint32_t node) {
    const auto first_child = static_cast<std::uint32_t>(octree_.nodes_.size());
    octree_.nodes_.insert(octree_.nodes_.end(), 8, OctreeNode{node, 0, 0});
    octree_.nodes_[node].first = first_child;
    octree_.nodes_[node].count = OctreeNode::kInterior;
    return first_child;
  }

  static Pending child_of(const Pending& pending, std::uint32_t first_child, std::uint32_t octant) {
    const std::int32_t half = pending.size / 2;
    const glm::ivec3 offset(octant & 1U, (octant >> 1U) & 1U, octant >> 2U);
    return {first_child + octant, pending.level + 1, pending.corner + offset * half, half};
  }

  void subdivide(const Pending& pending, std::span<const scenes::PrimitiveId> primitives) {
    octree_.deepest_level_ = std::max(octree_.deepest_level_, pending.level);
    if (is_foreign(pending)) primitives = {};
    if (!must_be_split(pending) &&
        (primitives.size() <= options_.max_objects || pending.level >= options_.max_level)) {
      make_leaf(pending.node, primitives);
      return;
    }
    const std::uint32_t first_child = split(pending.node);
    const auto ends = distribute(pending, primitives);
    const auto& list = lists_[static_cast<std::size_t>(pending.level) + 1];
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      const std::size_t begin = octant == 0 ? 0 : ends[octant - 1];
      subdivide(child_of(pending, first_child, octant),
                std::span(list).subspan(begin, ends[octant] - begin));
    }
  }

  bool is_foreign(const Pending& pending) const {
    return part_ != nullptr && pending.level == part_->level &&
           !part_->own(pending.corner / pending.size);
  }
  bool must_be_split(const Pending& pending) const {
    return part_ != nullptr && pending.level < part_->level;
  }

  void make_leaf(std::uint32_t node, std::span<const scenes::PrimitiveId> primitives) {
    auto& references = octree_.references_;
    if (references.size() + primitives.size() > options_.max_references) {
      throw InputError(fmt::format(
          "the octree of max_level {} over '{}' ({} primitives) holds more than {} references; "
          "lower max_level, raise max_objects, or raise max_references (4 bytes each)",
          options_.max_level, scene_.name, scene_.primitives.size(), options_.max_references));
    }
    octree_.nodes_[node].first = static_cast<std::uint32_t>(references.size());
    octree_.nodes_[node].count = static_cast<std::uint32_t>(primitives.size());
    references.insert(references.end(), primitives.begin(), primitives.end());
  }

  /// Writes the children's lists, one after the other, to the next level's array; returns where
  /// each ends. A stable counting sort, which keeps ids in increasing order.
  std::array<std::size_t, 8> distribute(const Pending& pending,
                                        std::span<const scenes::PrimitiveId> primitives) {
    auto& octants = octants_[static_cast<std::size_t>(pending.level)];
    octants.resize(primitives.size());
    std::array<std::size_t, 8> ends{};
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      octants[i] = overlapped_octants(pending, primitives[i]);
      for (std::uint32_t rest = octants[i]; rest != 0; rest &= rest - 1) {
        ++ends[static_cast<std::size_t>(std::countr_zero(rest))];
      }
    }
    std::array<std::size_t, 8> next{};
    for (std::size_t octant = 1; octant < 8; ++octant) {
      next[octant] = ends[octant - 1];
      ends[octant] += ends[octant - 1];
    }
    auto& list = lists_[static_cast<std::size_t>(pending.level) + 1];
    list.resize(ends[7]);
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      for (std::uint32_t rest = octants[i]; rest != 0; rest &= rest - 1) {
        list[next[static_cast<std::size_t>(std::countr_zero(rest))]++] = primitives[i];
      }
    }
    return ends;
  }

  /// The children that a primitive of the node belongs to, as a bit mask.
  std::uint8_t overlapped_octants(const Pending& pending, scenes::PrimitiveId id) const {
    constexpr std::array<std::uint8_t, 3> kLowHalf{0x55, 0x33,
                                                   0x0F};  // octants with the axis' bit 0
    const CellRange& range = ranges_[id];
    const std::int32_t half = pending.size / 2;
    std::uint8_t octants = 0xFF;
    int axes_crossed = 0;
    bool contained = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t corner = pending.corner[static_cast<int>(axis)];
      const bool low = range.first[axis] < corner + half;
      const bool high = range.last[axis] >= corner + half;
      contained =
          contained && range.first[axis] >= corner && range.last[axis] < corner + pending.size;
      if (low && high) {
        ++axes_crossed;
      } else {
        octants &= low ? kLowHalf[axis] : static_cast<std::uint8_t>(~kLowHalf[axis]);
      }
    }
    // One octant is left, or a connected surface inside the node crosses one plane: no test needed.
    if (axes_crossed == 0 || (axes_crossed == 1 && contained)) return octants;
    if (options_.assign == OctreeOptions::Assign::kBounds) return octants;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      if ((octants >> octant & 1U) == 0) continue;
      const glm::ivec3 offset(octant & 1U, (octant >> 1U) & 1U, octant >> 2U);
      if (!surface_overlaps(scene_, id, octree_.grid_.box(pending.corner + offset * half, half),
                            tolerance_)) {
        octants &= static_cast<std::uint8_t>(~(1U << octant));
      }
    }
    return octants;
  }

  const scenes::Scene& scene_;
  const OctreeOptions& options_;
  Octree& octree_;
  const OctreePart* part_;
  double tolerance_;
  std::vector<CellRange> ranges_;                        ///< in finest cells, by primitive
  std::vector<std::vector<scenes::PrimitiveId>> lists_;  ///< by level
  std::vector<std::vector<std::uint8_t>> octants_;       ///< by level
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
