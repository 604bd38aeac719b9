// The rays of a part of a pencil as its apex sees them: projected, grouped, and written back.

#if defined(ACCEL_TILE_BEAM_PENCIL_POINTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_POINTS_INL
#undef ACCEL_TILE_BEAM_PENCIL_POINTS_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_POINTS_INL
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "accel/core/ray.hpp"
#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"
#include "accel/tile_beam/prefetch-inl.hpp"
#include "accel/tile_beam/raster_samples-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// The lanes whose sign bit is set.
HWY_INLINE Mask is_negative(Floats values) {
  return hn::RebindMask(Tag(), hn::Lt(hn::BitCast(IntTag(), values), hn::Zero(IntTag())));
}
HWY_INLINE Floats either(Floats a, Floats b, Floats c) { return hn::Or3(a, b, c); }
HWY_INLINE float least_of(Floats values) { return hn::GetLane(hn::MinOfLanes(Tag(), values)); }
HWY_INLINE float most_of(Floats values) { return hn::GetLane(hn::MaxOfLanes(Tag(), values)); }
/// The lanes from `first` on of sixteen bits.
HWY_INLINE Mask lanes_of(LaneBits bits, std::size_t first) { return mask_of(bits >> first); }

/// Component by component.
struct RayLanes {
  Points origin;
  Points direction;
  Floats t_min;
  Floats t_max;
};

/// As many rays as a register has lanes.
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

/// The even bits of the result are the eight bits of each lane.
HWY_INLINE Ints spread_bits(Ints bits) {
  const IntTag d;
  bits = hn::And(hn::Or(bits, hn::ShiftLeft<4>(bits)), hn::Set(d, 0x0F0F));
  bits = hn::And(hn::Or(bits, hn::ShiftLeft<2>(bits)), hn::Set(d, 0x3333));
  return hn::And(hn::Or(bits, hn::ShiftLeft<1>(bits)), hn::Set(d, 0x5555));
}

/// Places on a side of the cube along a Z-order curve of 256 x 256 cells over an extent.
class MortonOrder {
 public:
  MortonOrder(float low_u, float high_u, float low_v, float high_v)
      : low_u_(low_u),
        low_v_(low_v),
        scale_u_(255.9F / std::max(high_u - low_u, 1e-30F)),
        scale_v_(255.9F / std::max(high_v - low_v, 1e-30F)) {}

  HWY_INLINE Ints keys(Floats u, Floats v) const {
    const auto cell = [](Floats place, float low, float scale) {
      return hn::ConvertTo(IntTag(), hn::Mul(hn::Sub(place, all(low)), all(scale)));
    };
    return hn::Or(spread_bits(cell(u, low_u_, scale_u_)),
                  hn::ShiftLeft<1>(spread_bits(cell(v, low_v_, scale_v_))));
  }

 private:
  float low_u_, low_v_, scale_u_, scale_v_;
};

/// Divides the first rays of a list into listed blocks: sixteen after the other or, where their
/// samples are known, those of a square of 4 x 4 pixels.
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
  /// Rays that begin farther from the apex along the side's axis are too far for float.
  float farthest;
};

/// Projects the rays of one side. `kToward`: the apex is at the rays' ends, and their points are
/// seen from it; otherwise at some distance behind their origins, and their directions are seen.
/// Returns the sides that other rays belong to, a bit each.
template <bool kToward>
class PencilProjection {
 public:
  PencilProjection(const PencilPart& part, CubeSide side, PencilUnit& unit)
      : part_(&part), side_(side), unit_(&unit) {}

  LaneBits operator()() {
    const std::size_t count = part_->rays.size();
    for (std::size_t block = 0; block < unit_->listed; ++block) {
      const std::size_t first = unit_->first[block];
      const LaneBits present = (LaneBits{1} << (unit_->first[block + 1] - first)) - 1;
      // The next unit's rays, while these are traced.
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
    return others_;
  }

 private:
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
          kToward ? hn::And(hn::Ge(ray.t_max, all(kLeastEnd)), hn::Le(ray.t_max, all(1.0F)))
                  : hn::Eq(ray.t_max, infinity);
      const Mask whole = hn::And(hn::Eq(ray.t_min, hn::Zero(Tag())), to_end);
      const Mask in = hn::And(
          hn::And(through, whole),
          hn::And(hn::Gt(hn::Min(depth, z), all(kNearest)), hn::Le(depth, all(part_->farthest))));
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

  /// The least depth and direction: reciprocals remain of ordinary size, and single rays can be
  /// probed (ProbeRay::can_probe).
  static constexpr float kNearest = 0x1p-59F;
  /// Rays that end farther before the apex, as those of points close to a light, are traced one by
  /// one.
  static constexpr float kLeastEnd = 0.5F;

  Floats end_depth_ = hn::Zero(Tag());
  const PencilPart* part_;
  CubeSide side_;
  PencilUnit* unit_;
  LaneBits others_ = 0;
};

/// Takes apart the blocks that are much larger than most, sorts their rays and puts these into
/// blocks anew; then orders all blocks, and makes groups of them.
class PencilGrouping {
 public:
  PencilGrouping(PencilUnit& unit, bool has_origin_w) : unit_(&unit), has_origin_w_(has_origin_w) {}

  void operator()() {
    find_extent();
    unit_->places = 0;
    unit_->groups = 0;
    unit_->groups_alive = 0;
    if (occupied_ == 0) return;
    const std::size_t pooled = pool_large_blocks();
    if (pooled > 0) {
      put_together(pooled);
      order_blocks();
    } else {
      for (std::size_t block = 0; block < unit_->listed; ++block) {
        unit_->slot[unit_->places] = static_cast<std::uint32_t>(block);
        unit_->places += unit_->lanes[block] != 0 ? 1 : 0;
      }
    }
    make_groups();
  }

 private:
  float extent(std::size_t block) const {
    const PencilUnit::Bounds& bounds = unit_->block;
    return (bounds.high_u[block] - bounds.low_u[block]) +
           (bounds.high_v[block] - bounds.low_v[block]);
  }

  void find_extent() {
    const PencilUnit::Bounds& bounds = unit_->block;
    std::int64_t bits = 0;
    std::int64_t extended = 0;
    for (std::size_t block = 0; block < unit_->listed; ++block) {
      if (unit_->lanes[block] == 0) continue;
      ++occupied_;
      low_u_ = std::min(low_u_, bounds.low_u[block]);
      high_u_ = std::max(high_u_, bounds.high_u[block]);
      low_v_ = std::min(low_v_, bounds.low_v[block]);
      high_v_ = std::max(high_v_, bounds.high_v[block]);
      const float size = extent(block);
      if (size <= 0.0F) continue;
      bits += std::bit_cast<std::int32_t>(size);
      ++extended;
    }
    // The mean of the bits is about that of the logarithms. In a list without order all blocks are
    // alike: none may be much larger than an equal part of the whole either.
    const float usual =
        extended > 0 ? std::bit_cast<float>(static_cast<std::int32_t>(bits / extended)) : 0.0F;
    const float equal_part = ((high_u_ - low_u_) + (high_v_ - low_v_)) /
                             std::sqrt(static_cast<float>(std::max<std::size_t>(occupied_, 1)));
    largest_ = kMuchLarger * std::min(usual, equal_part);
  }

  /// Moves the rays of large blocks behind those in blocks; returns how many there are.
  std::size_t pool_large_blocks() {
    std::size_t pooled = 0;
    for (std::size_t block = 0; block < unit_->listed; ++block) {
      if (unit_->lanes[block] == 0 || !(extent(block) > largest_)) continue;
      for (LaneBits left = unit_->lanes[block]; left != 0; left &= left - 1) {
        pool_[pooled++] = static_cast<std::uint16_t>(
            block * PencilUnit::kBlock + static_cast<std::size_t>(std::countr_zero(left)));
      }
      unit_->lanes[block] = 0;
    }
    return pooled;
  }

  /// Sorts them along the curve, by two passes of counting.
  void put_together(std::size_t pooled) {
    const MortonOrder order(low_u_, high_u_, low_v_, high_v_);
    alignas(64) std::array<float, 16> u{};
    alignas(64) std::array<float, 16> v{};
    alignas(64) std::array<std::int32_t, 16> keys;
    std::array<std::uint16_t, PencilUnit::kRays> key;
    std::array<std::array<std::uint16_t, 256>, 2> next{};
    for (std::size_t first = 0; first < pooled; first += 16) {
      const std::size_t count = std::min<std::size_t>(16, pooled - first);
      for (std::size_t i = 0; i < count; ++i) {
        u[i] = unit_->u[pool_[first + i]];
        v[i] = unit_->v[pool_[first + i]];
      }
      for (std::size_t lane = 0; lane < 16; lane += kLanes) {
        hn::Store(order.keys(load(&u[lane]), load(&v[lane])), IntTag(), &keys[lane]);
      }
      for (std::size_t i = 0; i < count; ++i) {
        key[first + i] = static_cast<std::uint16_t>(keys[i]);
        ++next[0][keys[i] & 255];
        ++next[1][keys[i] >> 8 & 255];
      }
    }
    for (auto& counts : next) {
      std::uint16_t sum = 0;
      for (std::uint16_t& count : counts)
        sum = static_cast<std::uint16_t>(sum + std::exchange(count, sum));
    }
    std::array<std::uint16_t, PencilUnit::kRays> by_low;
    for (std::size_t i = 0; i < pooled; ++i) {
      by_low[next[0][key[i] & 255U]++] = static_cast<std::uint16_t>(i);
    }
    for (std::size_t i = 0; i < pooled; ++i) {
      const std::size_t k = by_low[i];
      put(next[1][key[k] >> 8U]++, pool_[k]);
    }
    for (std::size_t i = pooled; i % PencilUnit::kBlock != 0; ++i) clear(i);
    const std::size_t blocks = (pooled + PencilUnit::kBlock - 1) / PencilUnit::kBlock;
    for (std::size_t block = 0; block < blocks; ++block) {
      const std::size_t left = pooled - block * PencilUnit::kBlock;
      find_bounds(PencilUnit::kListed + block, left >= 16 ? 0xFFFFU : (LaneBits{1} << left) - 1);
    }
    made_ = blocks;
  }

  void put(std::size_t place, std::size_t from) {
    const std::size_t at = PencilUnit::kRays + place;
    unit_->source[place] = static_cast<std::uint16_t>(unit_->ray_at(from));
    unit_->u[at] = unit_->u[from];
    unit_->v[at] = unit_->v[from];
    unit_->w[at] = unit_->w[from];
    if (has_origin_w_) unit_->origin_w[at] = unit_->origin_w[from];
  }
  void clear(std::size_t place) {
    const std::size_t at = PencilUnit::kRays + place;
    unit_->u[at] = unit_->v[at] = unit_->w[at] = unit_->origin_w[at] = kNaN;
  }

  HWY_INLINE void find_bounds(std::size_t block, LaneBits lanes) {
    PencilUnit::Bounds& bounds = unit_->block;
    const std::size_t at = block * PencilUnit::kBlock;
    const auto reduce = [&](const float* values, float& low, float& high) {
      Floats least = all(kInfinity), most = all(-kInfinity);
      for (std::size_t lane = 0; lane < 16; lane += kLanes) {
        const Mask in = lanes_of(lanes, lane);
        const Floats some = load(values + at + lane);
        least = hn::Min(least, hn::IfThenElse(in, some, all(kInfinity)));
        most = hn::Max(most, hn::IfThenElse(in, some, all(-kInfinity)));
      }
      low = least_of(least);
      high = most_of(most);
    };
    float unused = 0.0F;
    unit_->lanes[block] = static_cast<std::uint16_t>(lanes);
    reduce(unit_->u.data(), bounds.low_u[block], bounds.high_u[block]);
    reduce(unit_->v.data(), bounds.low_v[block], bounds.high_v[block]);
    reduce(unit_->w.data(), bounds.least_w[block], unused);
    if (has_origin_w_) reduce(unit_->origin_w.data(), unused, bounds.most_origin_w[block]);
  }

  /// Along the curve, by their middles, in 256 cells.
  void order_blocks() {
    const MortonOrder order(low_u_, high_u_, low_v_, high_v_);
    std::array<std::uint16_t, 257> next{};
    std::array<std::uint8_t, PencilUnit::kBlocks> key;
    const PencilUnit::Bounds& bounds = unit_->block;
    const auto for_each_block = [&](auto visit) {
      for (std::size_t block = 0; block < unit_->listed; ++block) {
        if (unit_->lanes[block] != 0) visit(block);
      }
      for (std::size_t block = 0; block < made_; ++block) visit(PencilUnit::kListed + block);
    };
    const auto find_keys = [&](std::size_t begin, std::size_t end) {
      alignas(64) std::array<std::int32_t, 16> keys;
      for (std::size_t block = begin; block < end; block += 16) {
        for (std::size_t lane = 0; lane < 16; lane += kLanes) {
          const auto middle = [&](const auto& low, const auto& high) {
            return hn::Mul(all(0.5F), hn::Add(load(&low[block + lane]), load(&high[block + lane])));
          };
          hn::Store(hn::ShiftRight<8>(order.keys(middle(bounds.low_u, bounds.high_u),
                                                 middle(bounds.low_v, bounds.high_v))),
                    IntTag(), &keys[lane]);
        }
        for (std::size_t i = 0; i < 16; ++i) key[block + i] = static_cast<std::uint8_t>(keys[i]);
      }
    };
    find_keys(0, unit_->listed);
    find_keys(PencilUnit::kListed, PencilUnit::kListed + made_);
    for_each_block([&](std::size_t block) { ++next[key[block] + 1U]; });
    for (std::size_t i = 1; i < next.size(); ++i)
      next[i] = static_cast<std::uint16_t>(next[i] + next[i - 1]);
    unit_->places = next.back();
    for_each_block([&](std::size_t block) {
      unit_->slot[next[key[block]]++] = static_cast<std::uint32_t>(block);
    });
  }

  void make_groups() {
    unit_->groups = (unit_->places + 15) / 16;
    const PencilUnit::Bounds& bounds = unit_->block;
    for (std::size_t group = 0; group < unit_->groups; ++group) {
      const std::size_t first = group * 16;
      const std::size_t count = std::min<std::size_t>(16, unit_->places - first);
      const LaneBits present = (LaneBits{1} << count) - 1;
      for (std::size_t i = count; i < 16; ++i) unit_->slot[first + i] = unit_->slot[first];
      for (std::size_t lane = 0; lane < 16; lane += kLanes) {
        const std::size_t at = first + lane;
        const Ints slots =
            hn::BitCast(IntTag(), hn::Load(hn::RebindToUnsigned<Tag>(), &unit_->slot[at]));
        const Mask in = lanes_of(present, lane);
        const auto gather = [&](const auto& values, float otherwise) {
          return hn::IfThenElse(in, hn::GatherIndex(Tag(), values.data(), slots), all(otherwise));
        };
        const Floats low_u = hn::Sub(gather(bounds.low_u, kInfinity), all(kPad));
        const Floats high_u = hn::Add(gather(bounds.high_u, -kInfinity), all(kPad));
        const Floats low_v = hn::Sub(gather(bounds.low_v, kInfinity), all(kPad));
        const Floats high_v = hn::Add(gather(bounds.high_v, -kInfinity), all(kPad));
        const Floats middle_u = hn::Mul(all(0.5F), hn::Add(low_u, high_u));
        const Floats middle_v = hn::Mul(all(0.5F), hn::Add(low_v, high_v));
        store(hn::Neg(low_u), &unit_->minus_low_u[at]);
        store(high_u, &unit_->high_u[at]);
        store(hn::Neg(low_v), &unit_->minus_low_v[at]);
        store(high_v, &unit_->high_v[at]);
        store(hn::Neg(gather(bounds.least_w, kInfinity)), &unit_->minus_w[at]);
        store(middle_u, &unit_->middle_u[at]);
        store(middle_v, &unit_->middle_v[at]);
        store(hn::Sub(high_u, middle_u), &unit_->half_u[at]);
        store(hn::Sub(high_v, middle_v), &unit_->half_v[at]);
        if (has_origin_w_) {
          store(gather(bounds.most_origin_w, -kInfinity), &unit_->origin_w_top[at]);
        }
      }
      for (std::size_t i = 0; i < 16; ++i) {
        unit_->alive[first + i] = i < count ? unit_->lanes[unit_->slot[first + i]] : 0;
      }
      unit_->group_blocks[group] = static_cast<std::uint16_t>(present);
      unit_->groups_alive |= 1U << group;
    }
  }

  /// How many times the usual extent a block must have to be taken apart: depth discontinuities.
  static constexpr float kMuchLarger = 2.8F;
  /// Of the bounds of a block: more than five roundings of places |u| <= 1, which bounds and edges
  /// may be wrong by.
  static constexpr float kPad = 3e-7F;

  PencilUnit* unit_;
  bool has_origin_w_;
  std::size_t occupied_ = 0;
  std::size_t made_ = 0;
  float low_u_ = kInfinity, high_u_ = -kInfinity, low_v_ = kInfinity, high_v_ = -kInfinity;
  float largest_ = 0.0F;
  std::array<std::uint16_t, PencilUnit::kRays> pool_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
