#pragma once
// Where a ray crosses the planes of a kd-tree.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "accel/core/ray.hpp"
#include "scenes/bounds.hpp"

namespace beambench::accel::kd_tree {

/// Derives everything about a ray and planes from one function, `plane_t`, in double, so that a
/// cell's exit and its neighbor's entry are the same number and no cell is skipped.
///
/// plane / direction - origin / direction is rounded where origin / direction is: the ray at that t
/// is off the plane by 2^-53 of the origin's coordinate, which the tolerance of cells holds. It is
/// one instruction, on which each step of a traversal waits, in place of two.
class KdRay {
 public:
  /// The ray's part inside a box, its ends included.
  struct Interval {
    double enter;
    double exit;

    bool empty() const { return !(enter <= exit); }
  };

  explicit KdRay(const Ray& ray) {
    // In place of infinity, for a ray parallel to the plane: the t of planes to its sides are then
    // beyond all others. A plane in which it runs counts as beside it, or is crossed at 0: cells
    // overlap by the tolerance, so that either side will do. Infinity would make it a NaN.
    constexpr double kParallel = 1e250;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<int>(axis);
      origin_[axis] = ray.origin[at];
      inverse_[axis] = ray.direction[at] == 0.0F ? kParallel : 1.0 / double{ray.direction[at]};
      offset_[axis] = -origin_[axis] * inverse_[axis];
      backward_ |= (ray.direction[at] < 0.0F ? 1U : 0U) << axis;
    }
  }

  [[gnu::always_inline]] double plane_t(std::size_t axis, float plane) const {
    return std::fma(double{plane}, inverse_[axis], offset_[axis]);
  }

  /// The child of a split across the axis that the ray comes from: 0 below the plane, 1 above.
  [[gnu::always_inline]] std::uint32_t first_child(std::size_t axis) const {
    return backward_ >> axis & 1U;
  }

  /// The part in a box of t that round to what is in [t_min, t_max].
  Interval clip(const scenes::Bounds& box, float t_min, float t_max) const {
    Interval part{std::nextafter(t_min, -kInfinity), std::nextafter(t_max, kInfinity)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = plane_t(axis, box.lower[static_cast<int>(axis)]);
      const double high = plane_t(axis, box.upper[static_cast<int>(axis)]);
      part.enter = std::max(part.enter, std::min(low, high));
      part.exit = std::min(part.exit, std::max(low, high));
    }
    return part;
  }

 private:
  std::array<double, 3> origin_;
  std::array<double, 3> inverse_;
  std::array<double, 3> offset_;
  std::uint32_t backward_ = 0;
};

}  // namespace beambench::accel::kd_tree
