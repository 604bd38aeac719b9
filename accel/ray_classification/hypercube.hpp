#pragma once
// Rays as points in five dimensions, and sets of rays as boxes of such points.

#include <algorithm>
#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

#include "accel/core/overlap.hpp"

namespace beambench::accel::ray_classification {

/// One of the six axis directions. In its coordinates, `along` is the axis along which a direction
/// is longest, with the sign that makes coordinates increase along rays.
struct Face {
  std::size_t along;
  std::array<std::size_t, 2> aside;
  double sign;

  static Face of(std::size_t number) {
    const std::size_t axis = number / 2;
    return {axis, {(axis + 1) % 3, (axis + 2) % 3}, number % 2 == 0 ? 1.0 : -1.0};
  }
};
inline constexpr std::size_t kFaces = 6;

/// The five coordinates of a ray seen from a face: its origin along and aside, and its slopes, the
/// direction's components aside divided by its component along.
inline constexpr std::size_t kDimensions = 5;
using Point = std::array<double, kDimensions>;

struct Interval {
  double low;
  double high;

  double size() const { return high - low; }
};

/// A set of rays of one face: its origins fill a box, its slopes two intervals.
using Hypercube = std::array<Interval, kDimensions>;

/// A box of the scene, seen from a face.
struct SeenBox {
  SeenBox(const Face& face, const Box& box) {
    const double near = face.sign * box.lower[static_cast<int>(face.along)];
    const double far = face.sign * box.upper[static_cast<int>(face.along)];
    along = {std::min(near, far), std::max(near, far)};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto axis = static_cast<int>(face.aside[i]);
      aside[i] = {box.lower[axis], box.upper[axis]};
    }
  }

  Interval along;
  std::array<Interval, 2> aside;
};

/// Reduces an interval of s to the part in which offset + slope * s <= 0.
inline void keep_below(double offset, double slope, Interval& s) {
  if (slope > 0.0) {
    s.high = std::min(s.high, -offset / slope);
  } else if (slope < 0.0) {
    s.low = std::max(s.low, -offset / slope);
  } else if (offset > 0.0) {
    s.high = -1.0;
  }
}

/// Returns whether a ray of the set may meet the box, that is, whether the positions of the set's
/// rays overlap the box at some distance s along the axis (Arvo and Kirk 1987, section 4, use a
/// linear program or bounding cones). Conservative: never false if a ray meets the box. It may be
/// true for no single ray, because it may combine one ray's origin along the axis with another's
/// origin aside.
inline bool may_meet(const Hypercube& rays, const SeenBox& box) {
  Interval s{std::max(0.0, box.along.low - rays[0].high), box.along.high - rays[0].low};
  for (std::size_t i = 0; i < 2; ++i) {
    const Interval& place = rays[1 + i];
    const Interval& slope = rays[3 + i];
    keep_below(place.low - box.aside[i].high, slope.low, s);
    keep_below(box.aside[i].low - place.high, -slope.high, s);
  }
  return s.low <= s.high;
}

/// Returns the dimension in which the set is largest relative to `whole`. Of equal dimensions, a
/// slope comes first.
inline std::size_t widest_dimension(const Hypercube& rays, const Hypercube& whole) {
  constexpr std::array<std::size_t, kDimensions> kOrder{3, 4, 1, 2, 0};
  return *std::max_element(kOrder.begin(), kOrder.end(), [&](std::size_t a, std::size_t b) {
    return rays[a].size() * whole[b].size() < rays[b].size() * whole[a].size();
  });
}

}  // namespace beambench::accel::ray_classification
