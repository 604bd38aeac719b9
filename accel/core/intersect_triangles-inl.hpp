// The canonical ray-triangle test for several pairs of a ray and a triangle by SIMD: the same
// operations in the same order as intersect_triangle, so that the results are bit-identical.

#if defined(ACCEL_CORE_INTERSECT_TRIANGLES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_CORE_INTERSECT_TRIANGLES_INL
#undef ACCEL_CORE_INTERSECT_TRIANGLES_INL
#else
#define ACCEL_CORE_INTERSECT_TRIANGLES_INL
#endif

#include <array>
#include <cstddef>

#include <hwy/highway.h>

#include "accel/core/intersect_triangle.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::CappedTag<double, 8>;
using Doubles = hn::Vec<DoubleTag>;
inline constexpr std::size_t kDoubleLanes = hn::MaxLanes(DoubleTag());

/// Pairs of a ray and a triangle, one for each lane of doubles.
struct RayTrianglePairs {
  using Tag = hn::Rebind<float, DoubleTag>;
  struct Point {
    hn::Vec<Tag> x, y, z;
  };
  Point origin;
  Point direction;
  std::array<Point, 3> corners;
};

struct DoublePoint {
  Doubles x, y, z;
};

// Not a friend defined in the class: GCC compiles those without the target's instruction set.
HWY_INLINE DoublePoint operator-(const DoublePoint& a, const DoublePoint& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Doubles dot(const DoublePoint& a, const DoublePoint& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE DoublePoint cross(const DoublePoint& a, const DoublePoint& b) {
  const auto minor = [](Doubles p, Doubles q, Doubles r, Doubles s) {
    return hn::Sub(hn::Mul(p, q), hn::Mul(r, s));
  };
  return {minor(a.y, b.z, b.y, a.z), minor(a.z, b.x, b.z, a.x), minor(a.x, b.y, b.x, a.y)};
}

/// Returns the lanes in which the point is near the triangle (`near_triangle`).
HWY_INLINE hn::Mask<DoubleTag> near_triangles(const DoublePoint& point,
                                              const std::array<DoublePoint, 3>& corners,
                                              const DoublePoint& normal, Doubles reach) {
  const DoubleTag d;
  const auto slack = hn::Mul(hn::Set(d, kHitSlack), reach);
  const auto outside = [&](Doubles place, Doubles a, Doubles b, Doubles c) {
    return hn::Or(hn::Lt(place, hn::Sub(hn::Min(hn::Min(a, b), c), slack)),
                  hn::Gt(place, hn::Add(hn::Max(hn::Max(a, b), c), slack)));
  };
  auto far = hn::Or(hn::Or(outside(point.x, corners[0].x, corners[1].x, corners[2].x),
                           outside(point.y, corners[0].y, corners[1].y, corners[2].y)),
                    outside(point.z, corners[0].z, corners[1].z, corners[2].z));
  const auto slack_squared = hn::Mul(hn::Mul(slack, slack), dot(normal, normal));
  for (std::size_t i = 0; i < 3; ++i) {
    const DoublePoint edge = corners[(i + 1) % 3] - corners[i];
    const auto inside = dot(cross(normal, edge), point - corners[i]);
    far = hn::Or(far,
                 hn::And(hn::Lt(inside, hn::Zero(d)),
                         hn::Gt(hn::Mul(inside, inside), hn::Mul(slack_squared, dot(edge, edge)))));
  }
  return hn::Not(far);
}

/// The values of the pairs in double.
struct DoublePairs {
  explicit HWY_INLINE DoublePairs(const RayTrianglePairs& pairs)
      : origin(widened(pairs.origin)),
        direction(widened(pairs.direction)),
        corners{widened(pairs.corners[0]), widened(pairs.corners[1]), widened(pairs.corners[2])},
        normal(cross(corners[1] - corners[0], corners[2] - corners[0])),
        along(dot(normal, direction)),
        t(hn::Div(dot(normal, corners[0] - origin), along)) {}

  static HWY_INLINE DoublePoint widened(const RayTrianglePairs::Point& from) {
    const DoubleTag d;
    return {hn::PromoteTo(d, from.x), hn::PromoteTo(d, from.y), hn::PromoteTo(d, from.z)};
  }

  DoublePoint origin;
  DoublePoint direction;
  std::array<DoublePoint, 3> corners;
  DoublePoint normal;
  Doubles along;  ///< normal . direction
  Doubles t;      ///< of the triangles' planes
};

/// Returns t as intersect_triangle computes it for a hit, not yet rounded and for any interval.
HWY_INLINE Doubles distances_along_rays(const RayTrianglePairs& pairs) {
  return DoublePairs(pairs).t;
}

/// Sets `t` to the same values, or to NaN for a miss; `accept` then checks the interval.
HWY_INLINE void intersect_triangles(const RayTrianglePairs& pairs, double* t) {
  const DoubleTag d;
  const DoublePairs in_double(pairs);
  const auto& [origin, direction, corners, normal, along, found] = in_double;

  // The main axis (`longest_axis`), which can differ in each lane.
  const DoublePoint size{hn::Abs(direction.x), hn::Abs(direction.y), hn::Abs(direction.z)};
  const auto x_beats_y = hn::Gt(size.x, size.y);
  const auto is_x = hn::And(x_beats_y, hn::Gt(size.x, size.z));
  const auto is_y = hn::AndNot(x_beats_y, hn::Gt(size.y, size.z));
  const auto pick = [&](Doubles for_x, Doubles for_y, Doubles for_z) {
    return hn::IfThenElse(is_x, for_x, hn::IfThenElse(is_y, for_y, for_z));
  };
  const auto along_main = pick(direction.x, direction.y, direction.z);
  const auto shear_0 = hn::Div(pick(direction.y, direction.z, direction.x), along_main);
  const auto shear_1 = hn::Div(pick(direction.z, direction.x, direction.y), along_main);
  struct Place {
    Doubles x, y;
  };
  const auto beside = [&](const DoublePoint& from_origin) -> Place {
    const auto along = pick(from_origin.x, from_origin.y, from_origin.z);
    return {hn::Sub(pick(from_origin.y, from_origin.z, from_origin.x), hn::Mul(shear_0, along)),
            hn::Sub(pick(from_origin.z, from_origin.x, from_origin.y), hn::Mul(shear_1, along))};
  };
  const std::array<DoublePoint, 3> from_origin{corners[0] - origin, corners[1] - origin,
                                               corners[2] - origin};
  const Place a = beside(from_origin[0]);
  const Place b = beside(from_origin[1]);
  const Place c = beside(from_origin[2]);
  const auto u = hn::Sub(hn::Mul(c.x, b.y), hn::Mul(c.y, b.x));
  const auto v = hn::Sub(hn::Mul(a.x, c.y), hn::Mul(a.y, c.x));
  const auto w = hn::Sub(hn::Mul(b.x, a.y), hn::Mul(b.y, a.x));
  const auto beyond = hn::And(hn::Lt(hn::Min(hn::Min(u, v), w), hn::Zero(d)),
                              hn::Gt(hn::Max(hn::Max(u, v), w), hn::Zero(d)));

  const auto reach_squared =
      hn::Max(hn::Max(dot(from_origin[0], from_origin[0]), dot(from_origin[1], from_origin[1])),
              dot(from_origin[2], from_origin[2]));
  const DoublePoint point{hn::Add(origin.x, hn::Mul(direction.x, found)),
                          hn::Add(origin.y, hn::Mul(direction.y, found)),
                          hn::Add(origin.z, hn::Mul(direction.z, found))};
  const auto miss =
      hn::Or(hn::Or(beyond, hn::Eq(along, hn::Zero(d))),
             hn::Not(near_triangles(point, corners, normal, hn::Sqrt(reach_squared))));
  hn::StoreU(hn::IfThenElse(miss, hn::Set(d, kMiss), found), d, t);
}

}  // namespace beambench::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
