#pragma once
// Computes where a ray crosses the planes of a kd-tree.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "accel/core/ray.hpp"
#include "scenes/bounds.hpp"

namespace beambench::accel::kd_tree {

/// A ray and the planes that it crosses. Everything is derived from one function, `plane_t`, in
/// double, so that a cell's exit and its neighbor's entry are the same number and no cell is
/// skipped.
///
/// The formula plane / direction - origin / direction has the rounding error of origin / direction:
/// the ray at the computed t is off the plane by 2^-53 of the origin's coordinate, which is within
/// the tolerance of cells. In return, each traversal step waits for one instruction instead of two.
class KdRay {
 public:
  /// The ray's part inside a box, including its ends.
  struct Interval {
    double enter;
    double exit;

    bool empty() const { return !(enter <= exit); }
  };

  explicit KdRay(const Ray& ray) {
    // Replaces infinity, which would cause a NaN, for a ray parallel to the plane. The t of a plane
    // beside the ray is then beyond all others. A plane that contains the ray counts as beside it
    // or as crossed at 0; either is correct, because cells overlap by the tolerance.
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

  /// Returns the child that the ray comes from, for a split across the axis: 0 below the plane, 1
  /// above.
  [[gnu::always_inline]] std::uint32_t first_child(std::size_t axis) const {
    return backward_ >> axis & 1U;
  }

  /// Returns the ray's part in a box whose t round to values in [t_min, t_max].
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
