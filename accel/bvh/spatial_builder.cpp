#include "accel/bvh/spatial_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <tbb/parallel_invoke.h>

#include "accel/bvh/box_quads.hpp"
#include "accel/bvh/clip.hpp"
#include "accel/bvh/object_split.hpp"
#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

/// The minimum overlap of children, relative to the root's surface, for which planes are tried.
constexpr double kMinOverlap = 1e-5;

/// References to pieces, each with the box of the part of the piece that it refers to.
using References = std::vector<BuildItem>;

struct TreeNode {
  QuadBox box;
  std::vector<std::uint32_t> items;                   ///< a leaf's items
  std::unique_ptr<std::array<TreeNode, 2>> children;  ///< null in a leaf
};

/// Divides a box along one axis into bins of equal width.
class AxisBins {
 public:
  static constexpr std::size_t kMaxBins = 32;

  AxisBins(const scenes::Bounds& box, int axis, std::size_t items)
      : lower_(box.lower[axis]),
        upper_(box.upper[axis]),
        count_(std::min(kMaxBins, 8 + items / 16)),
        scale_(static_cast<float>(count_) / (upper_ - lower_)) {}

  /// Returns false if the box is flat, or so thin that planes coincide.
  bool divides() const { return std::isfinite(scale_) && plane(1) > lower_ && scale_ > 0.0F; }
  std::size_t count() const { return count_; }
  /// Returns the start of bin `bin`; for `count()`, the end of the last bin.
  float plane(std::size_t bin) const {
    if (bin == count_) return upper_;
    return lower_ + (upper_ - lower_) * (static_cast<float>(bin) / static_cast<float>(count_));
  }
  /// Returns the bin of a coordinate in the box; the planes of lower bins are at most the
  /// coordinate.
  std::size_t bin(float coordinate) const {
    const float place = std::max((coordinate - lower_) * scale_, 0.0F);
    std::size_t found = std::min(static_cast<std::size_t>(place), count_ - 1);
    while (found > 0 && plane(found) > coordinate) --found;
    while (found + 1 < count_ && plane(found + 1) <= coordinate) ++found;
    return found;
  }

 private:
  float lower_;
  float upper_;
  std::size_t count_;
  float scale_;
};

struct SpatialSplit {
  float cost = std::numeric_limits<float>::infinity();
  int axis = -1;  ///< -1: no split is possible
  float plane = 0.0F;
  QuadBox left_box;  ///< the box of the parts on this side
  QuadBox right_box;
  std::uint32_t left_count = 0;
  std::uint32_t right_count = 0;
};

/// The references of a node's two children.
struct Division {
  References left;
  References right;
};

BuildExtent extent_of(const References& references) {
  BuildExtent extent;
  for (const BuildItem& reference : references) extent.include(reference);
  return extent;
}

float area(const QuadBox& box) {
  const scenes::Bounds bounds = box.bounds();
  return bounds.empty() ? 0.0F : static_cast<float>(half_area(bounds));
}

QuadBox united(QuadBox a, const QuadBox& b) {
  a.include(b);
  return a;
}

class SpatialBuilder {
 public:
  SpatialBuilder(const scenes::Scene& scene, std::span<const PrimitivePart> pieces,
                 const BvhOptions& options)
      : scene_(scene), pieces_(pieces), options_(options) {}

  TreeNode build() {
    References references;
    references.reserve(pieces_.size());
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      references.emplace_back(part_bounds(scene_, pieces_[i]), i);
    }
    const BuildExtent extent = extent_of(references);
    root_area_ = half_area(extent.boxes.bounds());
    TreeNode root;
    const std::size_t spare = references.size();
    subdivide(root, std::move(references), extent, 1, spare);
    return root;
  }

 private:
  /// `spare`: the number of references that may be added below the node.
  void subdivide(TreeNode& node, References references, const BuildExtent& extent,
                 std::uint32_t depth, std::size_t spare) {
    node.box = extent.boxes;
    const std::size_t count = references.size();
    std::optional<Division> division = divide(references, extent, depth, spare);
    if (!division) {
      for (const BuildItem& reference : references) node.items.push_back(reference.index());
      return;
    }
    references = {};
    node.children = std::make_unique<std::array<TreeNode, 2>>();
    const std::size_t left_count = division->left.size();
    const std::size_t both = left_count + division->right.size();
    const std::size_t rest = spare - (both - count);
    const auto left_spare = static_cast<std::size_t>(
        static_cast<double>(rest) * static_cast<double>(left_count) / static_cast<double>(both));
    const auto make_left = [&] {
      const BuildExtent own = extent_of(division->left);
      subdivide((*node.children)[0], std::move(division->left), own, depth + 1, left_spare);
    };
    const auto make_right = [&] {
      const BuildExtent own = extent_of(division->right);
      subdivide((*node.children)[1], std::move(division->right), own, depth + 1, rest - left_spare);
    };
    if (options_.parallel && count >= kParallelItems) {
      tbb::parallel_invoke(make_left, make_right);
    } else {
      make_left();
      make_right();
    }
  }

  /// Returns the division of a node, or nothing for a leaf.
  std::optional<Division> divide(const References& references, const BuildExtent& extent,
                                 std::uint32_t depth, std::size_t spare) const {
    if (references.size() == 1) return std::nullopt;
    if (depth < kDeepestSahSplit) {
      const Binning binning(extent.centers, references.size());
      Bins bins(binning);
      for (const BuildItem& reference : references) bins.include(reference);
      const ObjectSplit by_objects = best_object_split(bins, binning, options_);
      SpatialSplit by_space;
      if (spare > 0 && children_overlap(bins, binning, by_objects)) {
        by_space = best_spatial_split(references, extent.boxes.bounds());
      }
      const auto is_leaf_cheaper = [&](float cost) {
        return leaf_pays(references.size(), extent.boxes.bounds(), cost, options_);
      };
      if (by_space.cost < by_objects.cost && !is_leaf_cheaper(by_space.cost)) {
        std::optional<Division> parts = split_space(references, by_space, spare);
        if (parts) return parts;
      }
      if (by_objects.axis >= 0 && !is_leaf_cheaper(by_objects.cost)) {
        return split_objects(references, binning, by_objects);
      }
    }
    if (references.size() <= options_.max_leaf) return std::nullopt;
    const auto middle = references.begin() + static_cast<std::ptrdiff_t>(references.size() / 2);
    return Division{{references.begin(), middle}, {middle, references.end()}};
  }

  /// Returns whether to try planes (section 4.5); also true if centers cannot be divided.
  bool children_overlap(const Bins& bins, const Binning& binning, const ObjectSplit& split) const {
    if (split.axis < 0) return true;
    const auto axis = static_cast<std::size_t>(split.axis);
    QuadBox left = QuadBox::empty();
    QuadBox right = QuadBox::empty();
    for (std::size_t bin = 0; bin < binning.count(); ++bin) {
      (bin < static_cast<std::size_t>(split.bin) ? left : right).include(bins.at(axis, bin).box);
    }
    const QuadBox common{larger(left.lower, right.lower), smaller(left.upper, right.upper)};
    return area(common) > kMinOverlap * root_area_;
  }

  /// Returns the part of a reference between two planes, or nothing if the piece has no part there.
  std::optional<QuadBox> part(const BuildItem& reference, int axis, float from, float to) const {
    const scenes::Bounds box = reference.box().bounds();
    Box between{glm::dvec3(box.lower), glm::dvec3(box.upper)};
    between.lower[axis] = std::max(between.lower[axis], static_cast<double>(from));
    between.upper[axis] = std::min(between.upper[axis], static_cast<double>(to));
    const std::optional<Box> found = clipped_bounds(scene_, pieces_[reference.index()], between);
    if (!found) return std::nullopt;
    QuadBox part = reference.box();
    for (int i = 0; i < 3; ++i) {
      // One float outward, but not beyond the reference's own box. Near a coordinate of 0, where
      // floats are finer than the clipping error, the padding of boxes covers that error.
      part.lower[i] = std::max(-next_above(-static_cast<float>(found->lower[i])), box.lower[i]);
      part.upper[i] = std::min(next_above(static_cast<float>(found->upper[i])), box.upper[i]);
    }
    return part;
  }

  /// Calls `visit` with boxes of a reference's parts in the bins [first, last]. For triangles, they
  /// follow from the points where the edges cross planes, ignoring earlier planes: good enough to
  /// estimate costs, and several times faster.
  template <class Visit>
  void cut(const BuildItem& reference, int axis, const AxisBins& bins, std::size_t first,
           std::size_t last, Visit visit) const {
    const PrimitivePart& piece = pieces_[reference.index()];
    if (scene_.primitives[piece.primitive].kind != scenes::PrimitiveKind::kPolygon) {
      for (std::size_t bin = first; bin <= last; ++bin) {
        const auto inside = part(reference, axis, bins.plane(bin), bins.plane(bin + 1));
        if (inside) visit(bin, *inside);
      }
      return;
    }
    std::array<Quad, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = quad_of(scene_.vertices[scene_.triangles[piece.index].vertex[i]]);
    }
    const auto crossings_at = [&](float plane) {
      QuadBox box = QuadBox::empty();
      for (std::size_t i = 0; i < 3; ++i) {
        const Quad& a = corners[i];
        const Quad& b = corners[(i + 1) % 3];
        if ((a[axis] < plane) == (b[axis] < plane)) continue;
        box.include(a + (b - a) * quad_of((plane - a[axis]) / (b[axis] - a[axis])));
      }
      return box;
    };
    float from = reference.box().lower[axis];
    QuadBox crossings = crossings_at(from);
    for (std::size_t bin = first; bin <= last; ++bin) {
      const float to = bin == last ? reference.box().upper[axis] : bins.plane(bin + 1);
      QuadBox box = crossings;
      crossings = crossings_at(to);
      box.include(crossings);
      for (const Quad& corner : corners) {
        if (corner[axis] >= from && corner[axis] <= to) box.include(corner);
      }
      const QuadBox inside{larger(box.lower, reference.box().lower),
                           smaller(box.upper, reference.box().upper)};
      if (!inside.bounds().empty()) visit(bin, inside);
      from = to;
    }
  }

  /// Finds the best plane (section 4.2): references are cut at the planes of bins; a bin counts the
  /// references that begin and those that end in it.
  SpatialSplit best_spatial_split(const References& references, const scenes::Bounds& box) const {
    SpatialSplit best;
    for (int axis = 0; axis < 3; ++axis) {
      const AxisBins bins(box, axis, references.size());
      if (bins.divides()) try_planes(references, axis, bins, best);
    }
    return best;
  }

  void try_planes(const References& references, int axis, const AxisBins& bins,
                  SpatialSplit& best) const {
    struct SpatialBin {
      QuadBox box = QuadBox::empty();
      std::uint32_t begins = 0;
      std::uint32_t ends = 0;
    };
    std::array<SpatialBin, AxisBins::kMaxBins> sums;
    for (const BuildItem& reference : references) {
      const std::size_t first = bins.bin(reference.box().lower[axis]);
      const std::size_t last = bins.bin(reference.box().upper[axis]);
      ++sums[first].begins;
      ++sums[last].ends;
      if (first == last) {
        sums[first].box.include(reference.box());
        continue;
      }
      cut(reference, axis, bins, first, last,
          [&](std::size_t bin, const QuadBox& inside) { sums[bin].box.include(inside); });
    }
    std::array<QuadBox, AxisBins::kMaxBins> right_box;  // box of the bins from i on
    std::array<std::uint32_t, AxisBins::kMaxBins> right_count{};
    QuadBox right = QuadBox::empty();
    std::uint32_t right_items = 0;
    for (std::size_t i = bins.count() - 1; i > 0; --i) {
      right.include(sums[i].box);
      right_items += sums[i].ends;
      right_box[i] = right;
      right_count[i] = right_items;
    }
    QuadBox left = QuadBox::empty();
    std::uint32_t left_items = 0;
    for (std::size_t i = 1; i < bins.count(); ++i) {
      left.include(sums[i - 1].box);
      left_items += sums[i - 1].begins;
      if (left_items == 0 || right_count[i] == 0) continue;
      const float cost = area(left) * leaf_cost(left_items, options_) +
                         area(right_box[i]) * leaf_cost(right_count[i], options_);
      if (cost < best.cost) {
        best = {cost, axis, bins.plane(i), left, right_box[i], left_items, right_count[i]};
      }
    }
  }

  /// Divides the references at a plane. Returns nothing if rounding leaves one side empty, or if
  /// more references would be added than allowed.
  std::optional<Division> split_space(const References& references, SpatialSplit split,
                                      std::size_t spare) const {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    Division division;
    for (const BuildItem& reference : references) {
      if (reference.box().upper[split.axis] < split.plane) {
        division.left.push_back(reference);
      } else if (reference.box().lower[split.axis] >= split.plane) {
        division.right.push_back(reference);
      } else {
        divide_reference(reference, part(reference, split.axis, -kFar, split.plane),
                         part(reference, split.axis, split.plane, kFar), split, division);
      }
    }
    const std::size_t both = division.left.size() + division.right.size();
    if (division.left.empty() || division.right.empty()) return std::nullopt;
    if (both > references.size() + spare) return std::nullopt;
    // The division would make no progress: both sides would hold all references.
    if (both == 2 * references.size()) return std::nullopt;
    return division;
  }

  /// Puts a part on each side, or the whole reference on one side if that costs less (section 4.4,
  /// which weighs by references, not by blocks). `split` holds the current boxes and counts of both
  /// sides, updated after each earlier decision.
  static void divide_reference(const BuildItem& reference, const std::optional<QuadBox>& left,
                               const std::optional<QuadBox>& right, SpatialSplit& split,
                               Division& division) {
    const auto both_cost = area(split.left_box) * static_cast<float>(split.left_count) +
                           area(split.right_box) * static_cast<float>(split.right_count);
    const QuadBox left_with = united(split.left_box, reference.box());
    const QuadBox right_with = united(split.right_box, reference.box());
    const float left_cost = area(left_with) * static_cast<float>(split.left_count) +
                            area(split.right_box) * (static_cast<float>(split.right_count) - 1.0F);
    const float right_cost = area(split.left_box) * (static_cast<float>(split.left_count) - 1.0F) +
                             area(right_with) * static_cast<float>(split.right_count);
    const bool whole_left = !right || (left && left_cost < both_cost && left_cost <= right_cost);
    const bool whole_right = !whole_left && (!left || right_cost < both_cost);
    if (whole_left) {
      division.left.push_back(reference);
      split.left_box = left_with;
      if (split.right_count > 0) --split.right_count;
    } else if (whole_right) {
      division.right.push_back(reference);
      split.right_box = right_with;
      if (split.left_count > 0) --split.left_count;
    } else {
      division.left.emplace_back(left->bounds(), reference.index());
      division.right.emplace_back(right->bounds(), reference.index());
    }
  }

  static Division split_objects(const References& references, const Binning& binning,
                                const ObjectSplit& split) {
    Division division;
    for (const BuildItem& reference : references) {
      const bool goes_left = binning.bins(reference.center())[split.axis] < split.bin;
      (goes_left ? division.left : division.right).push_back(reference);
    }
    return division;
  }

  const scenes::Scene& scene_;
  std::span<const PrimitivePart> pieces_;
  BvhOptions options_;
  double root_area_ = 0.0;
};

/// Copies the tree: siblings together, each pair's children after it.
BinaryBvh flatten(const TreeNode& root, double tolerance) {
  struct Copied {
    const TreeNode* from;
    std::uint32_t node;
    std::uint32_t depth;
  };
  BinaryBvh bvh;
  bvh.nodes.push_back({});
  std::vector<Copied> waiting{{&root, 0, 1}};
  while (!waiting.empty()) {
    const Copied copied = waiting.back();
    waiting.pop_back();
    bvh.depth = std::max(bvh.depth, copied.depth);
    BvhNode node{padded(copied.from->box.bounds(), tolerance), 0, 0};
    if (copied.from->children) {
      node.first = static_cast<std::uint32_t>(bvh.nodes.size());
      bvh.nodes.resize(bvh.nodes.size() + 2);
      waiting.push_back({&(*copied.from->children)[1], node.first + 1, copied.depth + 1});
      waiting.push_back({&(*copied.from->children)[0], node.first, copied.depth + 1});
    } else {
      const auto& items = copied.from->items;
      node.first = static_cast<std::uint32_t>(bvh.items.size());
      node.count = static_cast<std::uint32_t>(items.size());
      bvh.items.insert(bvh.items.end(), items.begin(), items.end());
    }
    bvh.nodes[copied.node] = node;
  }
  return bvh;
}

}  // namespace

BinaryBvh build_spatial_bvh(const scenes::Scene& scene, std::span<const PrimitivePart> pieces,
                            double tolerance, const BvhOptions& options) {
  if (pieces.empty()) return {};
  return flatten(SpatialBuilder(scene, pieces, options).build(), tolerance);
}

}  // namespace beambench::accel::bvh
