// The float tests of streams, compiled for each instruction set: rays in lanes against one box or
// primitive, or one ray against several boxes or primitives in lanes.

#if defined(ACCEL_BVH_STREAM_TESTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_BVH_STREAM_TESTS_INL
#undef ACCEL_BVH_STREAM_TESTS_INL
#else
#define ACCEL_BVH_STREAM_TESTS_INL
#endif

#include <cstddef>

#include <hwy/highway.h>

#include "accel/bvh/stream_tree.hpp"
#include "accel/core/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace accel::HWY_NAMESPACE;

// Let e = 2^-24 (a rounding's relative error), S = StreamTree::half_size, o and d the origin and
// the direction of a ray, and R = |o - center| + S, which is at least the distance along any axis
// from the origin to any place in the scene. Norms of o and R are maximum norms; |d| is the sum of
// the components' absolute values. Rays in streams satisfy `can_stream`: |o - center| <= 4 S, and
// the largest component of d is in [2^-20, 2^20]; components smaller than 1e-18 were replaced by
// 1e-18, which moves no point in the scene by more than 2^-36 R.

/// The three coordinates of points or vectors, one in each lane.
template <class D>
struct Triple {
  hn::Vec<D> x;
  hn::Vec<D> y;
  hn::Vec<D> z;
};

/// Returns the sum of the components' absolute values.
template <class D>
HWY_INLINE hn::Vec<D> size_of(const Triple<D>& v) {
  return hn::Add(hn::Add(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}

template <class D>
HWY_INLINE hn::Vec<D> dot_of(const Triple<D>& a, const Triple<D>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

template <class D>
HWY_INLINE Triple<D> difference(const Triple<D>& a, const Triple<D>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

/// Returns 1 / values with an error of at most 5 e; NaN or infinity for 0.
template <class D>
HWY_INLINE hn::Vec<D> inverse_of(D d, hn::Vec<D> values) {
#if HWY_ARCH_X86
  // An estimate of twelve bits or more, and a step of Newton's method.
  const auto about = hn::ApproximateReciprocal(values);
  return hn::MulAdd(hn::NegMulAdd(about, values, hn::Set(d, 1.0F)), about, about);
#else
  return hn::Div(hn::Set(d, 1.0F), values);  // NEON estimates eight bits
#endif
}

/// Returns R.
template <class D>
HWY_INLINE hn::Vec<D> reach_of(const Triple<D>& origin, const StreamTree& tree) {
  const D d;
  const auto from_center = [&](hn::Vec<D> place, float center) {
    return hn::Abs(hn::Sub(place, hn::Set(d, center)));
  };
  const auto farthest =
      hn::Max(hn::Max(from_center(origin.x, tree.center.x), from_center(origin.y, tree.center.y)),
              from_center(origin.z, tree.center.z));
  return hn::Add(farthest, hn::Set(d, tree.half_size));
}

/// Rays, or one ray in all lanes.
template <class D>
struct LaneRays {
  Triple<D> origin;
  hn::Vec<D> t_min;
  Triple<D> direction;
  hn::Vec<D> t_max;
};

/// **Boxes.** On each axis t = (c - (o - center)) / d -+ h / |d|, with the child's center c and
/// half size h. The roundings of o - center, of its product with 1 / d, of that of c and of h, and
/// of the two sums move a plane by at most (4 + 4 + 1 + 1 + 5 + 6) e S; 1 / d is off by 5 e,
/// which moves it by 30 e S; and a t that was rounded to float lies up to 6 e S from its own place.
/// Boxes are widened by 64 e S, so that a hit in a box is never outside the computed interval.
template <class D>
class SlabLanes {
 public:
  HWY_INLINE SlabLanes(const LaneRays<D>& rays, const StreamTree& tree) {
    const D d;
    const auto set_axis = [&](hn::Vec<D> origin, hn::Vec<D> direction, float center, auto& axis) {
      axis.inverse = inverse_of(d, direction);
      axis.start = hn::Mul(hn::Sub(origin, hn::Set(d, center)), axis.inverse);
      axis.size = hn::Abs(axis.inverse);
    };
    set_axis(rays.origin.x, rays.direction.x, tree.center.x, x_);
    set_axis(rays.origin.y, rays.direction.y, tree.center.y, y_);
    set_axis(rays.origin.z, rays.direction.z, tree.center.z, z_);
  }

  /// Returns the lanes in which ray and box may meet in [t_min, t_max], and sets the t at which the
  /// box is entered.
  HWY_INLINE hn::Mask<D> meet(const Triple<D>& center, const Triple<D>& half, hn::Vec<D> t_min,
                              hn::Vec<D> t_max, hn::Vec<D>& enter) const {
    const auto x = hn::MulSub(center.x, x_.inverse, x_.start);
    const auto y = hn::MulSub(center.y, y_.inverse, y_.start);
    const auto z = hn::MulSub(center.z, z_.inverse, z_.start);
    enter = hn::Max(hn::Max(hn::NegMulAdd(half.x, x_.size, x), hn::NegMulAdd(half.y, y_.size, y)),
                    hn::Max(hn::NegMulAdd(half.z, z_.size, z), t_min));
    const auto exit =
        hn::Min(hn::Min(hn::MulAdd(half.x, x_.size, x), hn::MulAdd(half.y, y_.size, y)),
                hn::Min(hn::MulAdd(half.z, z_.size, z), t_max));
    return hn::Le(enter, exit);
  }

 private:
  struct Axis {
    hn::Vec<D> inverse;
    hn::Vec<D> start;
    hn::Vec<D> size;
  };
  Axis x_;
  Axis y_;
  Axis z_;
};

/// **Triangles.** Let s be at least the longest side of the box of any triangle of the leaf, a, b,
/// c the corners, e1 = b - a, e2 = c - a, n = e1 x e2, and M the larger of the sum of the sizes of
/// n's components and an eighth of the square of the longest side of the triangle's own box. The
/// canonical test accepts if u = -(d x (a - o)) . e2, v = (d x (a - o)) . e1 and w = d . n - u - v
/// have one sign, t = (n . (a - o)) / (d . n) is in the interval, and the point at t is near the
/// triangle (`near_triangle`): its signs and t are those of exact arithmetic up to 2^-50 of the
/// sizes below.
/// - u and v are sums of six products of at most R |d| s, in total 2 R s |d|, each with a relative
///   error of 7 e: u and v are off by 14 e R s |d|. d . n is off by 4 e M |d|, where M <= 6 s^2; w
///   is off by the sum of these and 8 e R s |d| for two more roundings: 36 e R s |d| + 24 e s^2
///   |d|.
/// - The sign of d . n, which orients u, v and w, is uncertain if d . n is within its error. For a
///   hit, all three are then within 2 x 24 e s^2 |d|, and their signs do not matter. So min(u, v,
///   w) >= -m with m = e s |d| (40 R + 80 s) for every hit.
/// - The numerator of t is off by 6 e M R. If |d . n| is more than 16 times its error, then t is
///   off by (6 e R + 4 e |t| |d|) M / |d . n| x 16 / 15 and some roundings, at most 16 e |t|.
///   Since M |d| >= |d . n|, these are at most (7 e R + 21 e |t| |d|) M / |d . n|.
/// - Let |d . n| >= 2^-7 M |d| and min(u, v, w) >= 2 m as computed, so that they are at least m.
///   Then the point is inside by 2^-20 R. In double, n is off by 2^-46 M, and t |d| by less than
///   2^-43 M |d| / |d . n| <= 2^-36 of the distance to the point. The point is off by as much,
///   and by 2^-52 of its coordinates: these are at most 2^13 times the distance if t |d| >= 2^-12
///   (R + |center|). Both together are less than `kHitSlack`, so the canonical test accepts if t is
///   in the interval.
/// Lengths that may underflow are replaced by larger ones: M by 2^-60 (StreamBlock), s by 2^-40.
template <class D>
class TriangleLanes {
 public:
  struct Found {
    hn::Mask<D> possible;  ///< the ray may hit the triangle in [t_min, t_max]
    hn::Mask<D> certain;   ///< the ray hits it, at t in [t_low, t_high]
    hn::Vec<D> t_low;
    hn::Vec<D> t_high;
  };

  HWY_INLINE TriangleLanes(const LaneRays<D>& rays, const StreamTree& tree, float leaf_extent)
      : rays_(&rays) {
    constexpr float kRounding = 0x1p-24F;
    const D d;
    const float extent = leaf_extent < 0x1p-40F ? 0x1p-40F : leaf_extent;
    const auto reach = reach_of(rays.origin, tree);
    const auto length = size_of(rays.direction);
    const auto per_length = inverse_of(d, length);
    const auto margin = hn::Mul(hn::Mul(length, hn::Set(d, kRounding * extent)),
                                hn::MulAdd(reach, hn::Set(d, 40.0F), hn::Set(d, 80.0F * extent)));
    least_area_ = hn::Neg(margin);
    certain_area_ = hn::Add(margin, margin);
    largest_ratio_ = hn::Mul(per_length, hn::Set(d, 127.0F));
    certain_t_ = hn::Max(rays.t_min, hn::Mul(hn::Add(reach, hn::Set(d, tree.center_size)),
                                             hn::Mul(per_length, hn::Set(d, 0x1.01p-12F))));
    t_error_ = hn::Mul(length, hn::Set(d, 21.0F * kRounding));
    start_error_ = hn::Mul(reach, hn::Set(d, 7.0F * kRounding));
  }

  /// `from_c`: a - c; `to_b`: b - a; `size`: M.
  HWY_INLINE Found operator()(const Triple<D>& a, const Triple<D>& from_c, const Triple<D>& to_b,
                              const Triple<D>& normal, hn::Vec<D> size, hn::Vec<D> t_max) const {
    const D d;
    const Triple<D>& along = rays_->direction;
    const Triple<D> to_a = difference(a, rays_->origin);
    const Triple<D> turned{hn::MulSub(along.y, to_a.z, hn::Mul(along.z, to_a.y)),
                           hn::MulSub(along.z, to_a.x, hn::Mul(along.x, to_a.z)),
                           hn::MulSub(along.x, to_a.y, hn::Mul(along.y, to_a.x))};
    const auto slope = dot_of(normal, along);
    const auto sign = hn::And(slope, hn::SignBit(d));
    const auto steepness = hn::Abs(slope);
    const auto u = hn::Xor(dot_of(turned, from_c), sign);
    const auto v = hn::Xor(dot_of(turned, to_b), sign);
    const auto inside = hn::Min(hn::Min(u, v), hn::Sub(steepness, hn::Add(u, v)));

    const auto height = hn::Xor(dot_of(normal, to_a), sign);
    const auto per_steepness = inverse_of(d, steepness);
    const auto ratio = hn::Mul(size, per_steepness);
    const auto t = hn::Mul(height, per_steepness);
    const auto error = hn::Mul(ratio, hn::MulAdd(hn::Abs(t), t_error_, start_error_));
    Found found;
    found.t_low = hn::Sub(t, error);
    found.t_high = hn::Add(t, error);
    const auto steep = hn::Lt(ratio, largest_ratio_);
    const auto in_time = hn::And(hn::Le(found.t_low, t_max), hn::Ge(found.t_high, rays_->t_min));
    found.possible = hn::And(hn::Ge(inside, least_area_), hn::Or(in_time, hn::Not(steep)));
    found.certain = hn::And(hn::And(steep, hn::Ge(inside, certain_area_)),
                            hn::And(hn::Ge(found.t_low, certain_t_), hn::Lt(found.t_high, t_max)));
    return found;
  }

 private:
  const LaneRays<D>* rays_;
  hn::Vec<D> least_area_;  ///< lower bound of u, v and w
  hn::Vec<D> certain_area_;
  hn::Vec<D> largest_ratio_;  ///< upper bound of M / |d . n|
  hn::Vec<D> certain_t_;      ///< the least t at which a hit is certain
  hn::Vec<D> t_error_;        ///< error of t, relative to |t| M / |d . n|
  hn::Vec<D> start_error_;    ///< error of t, relative to M / |d . n|
};

/// **Spheres.** As in ProbeRay's test, the vector from the center to the nearest point of the line
/// is wrong by at most 21 e R; 32 e R is added to the radius, and as much to the depth.
template <class D>
class SphereLanes {
 public:
  HWY_INLINE SphereLanes(const LaneRays<D>& rays, const StreamTree& tree) : rays_(&rays) {
    const D d;
    const auto reach = reach_of(rays.origin, tree);
    margin_ = hn::Mul(reach, hn::Set(d, 32.0F * 0x1p-24F));
    per_square_ = hn::Div(hn::Set(d, 1.0F), dot_of(rays.direction, rays.direction));
    per_length_ = hn::Sqrt(per_square_);
  }

  /// Returns the lanes in which the ray may hit the sphere in [t_min, t_max].
  HWY_INLINE hn::Mask<D> operator()(const Triple<D>& center, hn::Vec<D> radius,
                                    hn::Vec<D> t_max) const {
    const D d;
    const auto wider = hn::Set(d, 1.0F + 0x1p-20F);
    const Triple<D> to_center = difference(center, rays_->origin);
    const Triple<D>& along = rays_->direction;
    const auto t = hn::Mul(dot_of(to_center, along), per_square_);
    const Triple<D> beside{hn::NegMulAdd(t, along.x, to_center.x),
                           hn::NegMulAdd(t, along.y, to_center.y),
                           hn::NegMulAdd(t, along.z, to_center.z)};
    const auto outer = hn::Mul(hn::Add(radius, margin_), wider);
    const auto half_chord =
        hn::MulAdd(outer, hn::Mul(per_length_, wider), hn::Mul(margin_, per_length_));
    const auto in_time = hn::And(hn::Le(hn::Sub(t, half_chord), hn::Mul(t_max, wider)),
                                 hn::Ge(hn::Mul(hn::Add(t, half_chord), wider), rays_->t_min));
    return hn::And(hn::Le(dot_of(beside, beside), hn::Mul(outer, outer)), in_time);
  }

 private:
  const LaneRays<D>* rays_;
  hn::Vec<D> margin_;
  hn::Vec<D> per_square_;
  hn::Vec<D> per_length_;
};

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
