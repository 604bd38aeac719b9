// The rays of a part of a pencil as seen from its apex: listed in blocks, and projected.

#if defined(ACCEL_TILE_BEAM_PENCIL_POINTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_POINTS_INL
#undef ACCEL_TILE_BEAM_PENCIL_POINTS_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_POINTS_INL
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "accel/core/ray.hpp"
#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"
#include "accel/tile_beam/prefetch-inl.hpp"
#include "accel/tile_beam/raster_samples-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Rays toward the apex: a hit ends a ray.
struct AnyHitPolicy {
  static constexpr bool kClosest = false;
  static constexpr bool kHull = false;
  /// The number of leaves per ray above which single rays are faster, as measured.
  static constexpr float kHandoverLeaves = 1.0F;
};
/// Rays away from the apex: a hit brings the ray's end nearer.
struct ClosestHitPolicy {
  static constexpr bool kClosest = true;
  static constexpr bool kHull = false;
  static constexpr float kHandoverLeaves = 3.0F;
};
/// Rays toward all apexes of a bundle at once: toward any point of a ball around the apex. If some
/// rays from an origin may hit a shape, `BundleTests` tests them or leaves the origin open.
///
/// Let x, y, z be the coordinates of a side of the cube about the ball's center, r its radius, P an
/// origin, with z > 2 r, and a a point of the ball. On the line from P to a, the point at depth z
/// has
///     u = u_P + (a.x - u_P a.z) (w - w_P) / (1 - a.z w_P).
/// As |u_P| <= 1, it differs from u_P by at most `spread` (w - w_P), where
///     spread = sqrt(2) r / (1 - r w_P).
/// So a shape is tested as in an any-hit query toward the center, but widened by this amount at its
/// largest w. Any ray may meet a shape nearer than z = 2 r.
struct HullPolicy {
  static constexpr bool kClosest = false;
  static constexpr bool kHull = true;
  static constexpr float kHandoverLeaves = AnyHitPolicy::kHandoverLeaves;
};

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Returns the lanes whose sign bit is set.
HWY_INLINE Mask is_negative(Floats values) {
  return hn::RebindMask(Tag(), hn::Lt(hn::BitCast(IntTag(), values), hn::Zero(IntTag())));
}
HWY_INLINE Floats either(Floats a, Floats b, Floats c) { return hn::Or3(a, b, c); }
HWY_INLINE float least_of(Floats values) { return hn::GetLane(hn::MinOfLanes(Tag(), values)); }
HWY_INLINE float most_of(Floats values) { return hn::GetLane(hn::MaxOfLanes(Tag(), values)); }
/// Returns the lanes from `first` on of sixteen bits.
HWY_INLINE Mask lanes_of(LaneBits bits, std::size_t first) { return mask_of(bits >> first); }

/// Rays, one per lane, component by component.
struct RayLanes {
  Points origin;
  Points direction;
  Floats t_min;
  Floats t_max;
};

/// Loads as many rays as a register has lanes.
HWY_INLINE RayLanes load_rays(const Ray* rays) {
#if HWY_TARGET == HWY_SCALAR
  return {all_of(rays->origin), all_of(rays->direction), all(rays->t_min), all(rays->t_max)};
#else
  static_assert(sizeof(Ray) == 8 * sizeof(float));
  const float* const from = &rays->origin.x;
  Floats x0, y0, z0, t0, x1, y1, z1, t1;
  hn::LoadInterleaved4(Tag(), from, x0, y0, z0, t0);
  hn::LoadInterleaved4(Tag(), from + 4 * kLanes, x1, y1, z1, t1);
  const auto even = [](Floats low, Floats high) { return hn::ConcatEven(Tag(), high, low); };
  const auto odd = [](Floats low, Floats high) { return hn::ConcatOdd(Tag(), high, low); };
  return {{even(x0, x1), even(y0, y1), even(z0, z1)},
          {odd(x0, x1), odd(y0, y1), odd(z0, z1)},
          even(t0, t1),
          odd(t0, t1)};
#endif
}

HWY_INLINE Floats coordinate(const Points& points, std::size_t axis) {
  return axis == 0 ? points.x : axis == 1 ? points.y : points.z;
}

/// Divides the first rays of a list into listed blocks: sixteen consecutive rays or, if their
/// samples are known, those in a square of 4 x 4 pixels.
inline void list_blocks(std::span<const Ray> rays, const PencilSamples& samples, PencilUnit& unit) {
  unit.listed = 0;
  unit.first[0] = 0;
  std::size_t next = 0;
  while (next < rays.size() && unit.listed < PencilUnit::kListed) {
    const std::size_t most = std::min(PencilUnit::kBlock, rays.size() - next);
    next += samples.of_rays.empty() ? most : run_in_square(samples, next, most);
    unit.first[++unit.listed] = static_cast<std::uint16_t>(next);
  }
}

/// The rays of a unit.
struct PencilPart {
  std::span<const Ray> rays;
  glm::vec3 apex;
  /// The maximum distance of a ray's origin from the apex, along the side's axis, at which float is
  /// accurate enough.
  float farthest;
  const BundleRays* bundle = nullptr;  ///< HullPolicy
};

/// Projects the rays of one side. In any-hit queries, the rays end at the apex, which sees their
/// origins; for closest hits, the apex is at some distance behind the origins and sees the
/// directions. Returns the sides of the other rays, one bit each.
template <class Policy>
class PencilProjection {
 public:
  PencilProjection(const PencilPart& part, CubeSide side, PencilUnit& unit)
      : part_(&part), side_(side), unit_(&unit) {}

  LaneBits operator()() {
    const std::size_t count = part_->rays.size();
    for (std::size_t block = 0; block < unit_->listed; ++block) {
      const std::size_t first = unit_->first[block];
      const LaneBits present = (LaneBits{1} << (unit_->first[block + 1] - first)) - 1;
      // Prefetches the next unit's rays while these are traced.
      prefetch_lines(&part_->rays[first] + PencilUnit::kRays, PencilUnit::kBlock * sizeof(Ray));
      if (first + PencilUnit::kBlock <= count) {
        project(block, &part_->rays[first], present);
      } else {
        std::array<Ray, PencilUnit::kBlock> last{};
        std::copy(part_->rays.begin() + static_cast<std::ptrdiff_t>(first), part_->rays.end(),
                  last.begin());
        project(block, last.data(), present);
      }
    }
    unit_->end_depth = most_of(end_depth_);
    unit_->least_depth = least_of(least_depth_);
    return others_;
  }

 private:
  static constexpr bool kToward = !Policy::kClosest;

  HWY_INLINE void project(std::size_t block, const Ray* rays, LaneBits present) {
    const Floats infinity = all(kInfinity);
    const Floats minus_infinity = all(-kInfinity);
    Floats low_u = infinity, high_u = minus_infinity;
    Floats low_v = infinity, high_v = minus_infinity;
    Floats least_w = infinity, most_origin_w = minus_infinity;
    const LaneBits inside = for_each_register([&](std::size_t lane) {
      const RayLanes ray = load_rays(rays + lane);
      const Points from_apex{hn::Sub(ray.origin.x, all(part_->apex.x)),
                             hn::Sub(ray.origin.y, all(part_->apex.y)),
                             hn::Sub(ray.origin.z, all(part_->apex.z))};
      const Points& seen = kToward ? from_apex : ray.direction;
      const Points size{hn::Abs(seen.x), hn::Abs(seen.y), hn::Abs(seen.z)};
      const Floats largest = hn::Max(size.x, hn::Max(size.y, size.z));
      const Floats sign = all(side_.sign());
      const Floats z = hn::Mul(coordinate(seen, side_.z_axis()), sign);
      const Floats depth = kToward ? z : hn::Mul(coordinate(from_apex, side_.z_axis()), sign);
      const Mask wanted = lanes_of(present, lane);
      const Mask through = hn::And(wanted, hn::Eq(z, largest));
      if (!hn::AllFalse(Tag(), hn::AndNot(through, wanted))) [[unlikely]] {
        find_others(seen, size, largest, wanted);
      }
      const Mask to_end =
          kToward ? hn::And(hn::Ge(ray.t_max, all(kMinEnd)), hn::Le(ray.t_max, all(1.0F)))
                  : hn::Eq(ray.t_max, infinity);
      // For a bundle, only the origins are projected: its rays may be shorter.
      const Mask whole =
          Policy::kHull ? wanted : hn::And(hn::Eq(ray.t_min, hn::Zero(Tag())), to_end);
      const float nearest =
          Policy::kHull ? std::max(2.0F * part_->bundle->radius, kNearest) : kNearest;
      const Mask in = hn::And(
          hn::And(through, whole),
          hn::And(hn::Gt(hn::Min(depth, z), all(nearest)), hn::Le(depth, all(part_->farthest))));
      const Floats inverse = hn::Div(all(1.0F), z);
      const Floats u =
          hn::IfThenElse(in, hn::Mul(coordinate(seen, side_.x_axis()), inverse), all(kNaN));
      const Floats v =
          hn::IfThenElse(in, hn::Mul(coordinate(seen, side_.y_axis()), inverse), all(kNaN));
      const std::size_t at = block * PencilUnit::kBlock + lane;
      store(u, &unit_->u[at]);
      store(v, &unit_->v[at]);
      low_u = hn::Min(low_u, hn::IfThenElse(in, u, infinity));
      high_u = hn::Max(high_u, hn::IfThenElse(in, u, minus_infinity));
      low_v = hn::Min(low_v, hn::IfThenElse(in, v, infinity));
      high_v = hn::Max(high_v, hn::IfThenElse(in, v, minus_infinity));
      if constexpr (kToward) {
        store(inverse, &unit_->w[at]);
        const Floats left = hn::Mul(hn::Sub(all(1.0F), ray.t_max), z);
        end_depth_ = hn::Max(end_depth_, hn::IfThenElseZero(in, left));
        if constexpr (Policy::kHull) {
          least_depth_ = hn::Min(least_depth_, hn::IfThenElse(in, z, infinity));
        }
        least_w = hn::Min(least_w, hn::IfThenElse(in, inverse, infinity));
      } else {
        const Floats origin_w = hn::Div(all(1.0F), depth);
        store(hn::Zero(Tag()), &unit_->w[at]);
        store(origin_w, &unit_->origin_w[at]);
        most_origin_w = hn::Max(most_origin_w, hn::IfThenElse(in, origin_w, minus_infinity));
      }
      return in;
    });
    unit_->lanes[block] = static_cast<std::uint16_t>(inside);
    PencilUnit::Bounds& bounds = unit_->block;
    bounds.low_u[block] = least_of(low_u);
    bounds.high_u[block] = most_of(high_u);
    bounds.low_v[block] = least_of(low_v);
    bounds.high_v[block] = most_of(high_v);
    if constexpr (kToward) {
      bounds.least_w[block] = least_of(least_w);
    } else {
      bounds.least_w[block] = 0.0F;
      bounds.most_origin_w[block] = most_of(most_origin_w);
    }
  }

  void find_others(const Points& seen, const Points& size, Floats largest, Mask wanted) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Mask through = hn::And(wanted, hn::Eq(coordinate(size, axis), largest));
      const Mask back = hn::And(through, is_negative(coordinate(seen, axis)));
      if (!hn::AllFalse(Tag(), hn::AndNot(back, through))) others_ |= 1U << (2 * axis);
      if (!hn::AllFalse(Tag(), back)) others_ |= 2U << (2 * axis);
    }
  }

  /// The minimum depth and direction, so that reciprocals are not too large and single rays can be
  /// probed (ProbeRay::can_probe).
  static constexpr float kNearest = 0x1p-59F;
  /// The minimum t_max of rays traced together; the apex is at t = 1. Rays that end earlier, such
  /// as those from points close to a light, are traced one by one.
  static constexpr float kMinEnd = 0.5F;

  Floats end_depth_ = hn::Zero(Tag());
  Floats least_depth_ = all(kInfinity);
  const PencilPart* part_;
  CubeSide side_;
  PencilUnit* unit_;
  LaneBits others_ = 0;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
