#pragma once
// Items in bins along each axis: what the builder finds its splits by.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "accel/bvh/box_quads.hpp"

namespace beambench::accel::bvh {

/// Maps centers to bins, on all axes.
class Binning {
 public:
  static constexpr std::size_t kMost = 32;

  Binning(const QuadBox& centers, std::size_t items) : lower_(centers.lower), scale_{} {
    // Of a few items fewer bins do: their sums would cost more than the items.
    count_ = std::min(kMost, 8 + items / 16);
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
  /// The bins of a center, an axis a lane.
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

/// The sums of items by bins: as many as the binning has, on each axis.
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
  std::array<std::array<Bin, Binning::kMost>, 3> axes_;
};

}  // namespace beambench::accel::bvh
