// Regroups the blocks of a part of a pencil: large blocks are rebuilt, and all blocks form groups.

#if defined(ACCEL_TILE_BEAM_PENCIL_GROUPING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_GROUPING_INL
#undef ACCEL_TILE_BEAM_PENCIL_GROUPING_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_GROUPING_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "accel/tile_beam/pencil_points-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Spreads the eight bits of each lane to the even bits of the result.
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

/// Splits blocks that are much larger than most, sorts their rays and forms new blocks from them;
/// then orders all blocks and forms groups.
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
    // The mean of the bits approximates the mean of the logarithms. In an unordered list all blocks
    // are similar, so also require that none be much larger than an equal share of the whole.
    const float usual =
        extended > 0 ? std::bit_cast<float>(static_cast<std::int32_t>(bits / extended)) : 0.0F;
    const float equal_part = ((high_u_ - low_u_) + (high_v_ - low_v_)) /
                             std::sqrt(static_cast<float>(std::max<std::size_t>(occupied_, 1)));
    largest_ = kMuchLarger * std::min(usual, equal_part);
  }

  /// Moves the rays of large blocks behind all other rays; returns their number.
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

  /// Sorts the pooled rays along the curve by a counting sort in two passes.
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

  /// Orders the blocks along the curve by their centers, in 256 cells.
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

  /// The factor by which a block must exceed the usual extent to be split, as at depth
  /// discontinuities.
  static constexpr float kMuchLarger = 2.8F;
  /// The padding of a block's bounds: more than five roundings of places |u| <= 1, the maximum
  /// error of bounds and edges.
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
