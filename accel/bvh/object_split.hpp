#pragma once
// Divides a node's items by their centers: the candidates of the binned builder.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "accel/bvh/box_quads.hpp"
#include "accel/bvh/bvh_builder.hpp"
#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {

/// Nodes at this depth and below are split in half, since 2^32 items can then need 32 more levels.
inline constexpr std::uint32_t kDeepestSahSplit = kMaxBvhDepth - 34;
/// The minimum number of items for which tasks save time.
inline constexpr std::size_t kParallelItems = 4096;

/// Maps centers to bins, on all axes.
class Binning {
 public:
  static constexpr std::size_t kMaxBins = 32;

  Binning(const QuadBox& centers, std::size_t items) : lower_(centers.lower), scale_{} {
    // Few items need fewer bins: summing the bins would cost more than the items.
    count_ = std::min(kMaxBins, 8 + items / 16);
    last_ = quad_of(static_cast<float>(count_ - 1));
    const glm::vec3 extent = centers.bounds().extent();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(extent[axis] > 0.0F)) continue;
      const float scale = static_cast<float>(count_) / extent[axis];
      // An extent so small that its inverse overflows cannot be divided.
      if (scale < std::numeric_limits<float>::max()) scale_[axis] = scale;
    }
  }

  std::size_t count() const { return count_; }
  bool divides(std::size_t axis) const { return scale_[axis] > 0.0F; }
  /// Returns the bins of a center, one axis per lane.
  IntQuad bins(Quad center) const {
    return __builtin_convertvector(smaller((center - lower_) * scale_, last_), IntQuad);
  }

 private:
  std::size_t count_;
  Quad lower_;
  Quad scale_;
  Quad last_;
};

struct Bin {
  QuadBox box;
  std::uint32_t count;

  void include(const Bin& other) {
    box.include(other.box);
    count += other.count;
  }
};

/// The sums of items in each bin, on each axis.
class Bins {
 public:
  explicit Bins(const Binning& binning) : binning_(&binning) {
    for (auto& bins : axes_) {
      std::fill_n(bins.begin(), binning.count(), Bin{QuadBox::empty(), 0});
    }
  }

  void include(const BuildItem& item) {
    const IntQuad bins = binning_->bins(item.center());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Bin& bin = axes_[axis][static_cast<std::size_t>(bins[axis])];
      bin.box.include(item.box());
      ++bin.count;
    }
  }
  void include(const Bins& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < binning_->count(); ++i) {
        axes_[axis][i].include(other.axes_[axis][i]);
      }
    }
  }

  const Bin& at(std::size_t axis, std::size_t bin) const { return axes_[axis][bin]; }

 private:
  const Binning* binning_;
  std::array<std::array<Bin, Binning::kMaxBins>, 3> axes_;
};

/// Items in a bin below `bin` go left.
struct ObjectSplit {
  float cost = std::numeric_limits<float>::infinity();
  int axis = -1;  ///< -1: no split is worthwhile or possible
  std::int32_t bin = 0;
};

/// Returns the cost of testing `count` items, block by block.
inline float leaf_cost(std::uint32_t count, const BvhOptions& options) {
  const std::uint32_t blocks = (count + options.block_size - 1) / options.block_size;
  return static_cast<float>(blocks);
}

/// Returns whether a leaf of `count` items is allowed and costs no more than a node whose children
/// cost `split_cost` (not yet divided by the area of `box`, the node's box).
inline bool leaf_pays(std::size_t count, const scenes::Bounds& box, float split_cost,
                      const BvhOptions& options) {
  const auto whole = static_cast<float>(half_area(box));
  return count <= options.max_leaf &&
         whole * leaf_cost(static_cast<std::uint32_t>(count), options) <=
             whole * options.node_cost + split_cost;
}

/// Returns the cheapest division of binned items, comparing all costs, axis by axis.
inline ObjectSplit best_object_split(const Bins& bins, const Binning& binning,
                                     const BvhOptions& options) {
  const auto cost_of = [&](const Bin& part) {
    return static_cast<float>(half_area(part.box.bounds())) * leaf_cost(part.count, options);
  };
  ObjectSplit best;
  std::array<float, Binning::kMaxBins> right_cost{};  // cost of the bins from i on
  std::array<std::uint32_t, Binning::kMaxBins> right_count{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!binning.divides(axis)) continue;
    Bin right{QuadBox::empty(), 0};
    for (std::size_t i = binning.count() - 1; i > 0; --i) {
      right.include(bins.at(axis, i));
      right_count[i] = right.count;
      right_cost[i] = cost_of(right);
    }
    Bin left{QuadBox::empty(), 0};
    for (std::size_t i = 1; i < binning.count(); ++i) {
      left.include(bins.at(axis, i - 1));
      if (left.count == 0 || right_count[i] == 0) continue;
      const float cost = cost_of(left) + right_cost[i];
      if (cost < best.cost) best = {cost, static_cast<int>(axis), static_cast<std::int32_t>(i)};
    }
  }
  return best;
}

}  // namespace beambench::accel::bvh
