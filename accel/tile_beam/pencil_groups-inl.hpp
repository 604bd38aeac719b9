// The groups of blocks of a part of a pencil: their bounds, and the rays that may still be hit.

#if defined(ACCEL_TILE_BEAM_PENCIL_GROUPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_GROUPS_INL
#undef ACCEL_TILE_BEAM_PENCIL_GROUPS_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_GROUPS_INL
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "accel/tile_beam/pencil_shapes-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Bounds on a side of the cube, by `Bound`.
using SideBounds = std::array<float, 6>;
enum Bound : std::size_t { kLowU, kHighU, kLowV, kHighV, kLowW, kHighW };

/// Returns values whose sign bit is clear in the lanes whose bounds overlap `within`.
template <class Policy>
HWY_INLINE Floats apart(const SeenBounds& seen, const PencilBounds& within, float spread) {
  const Floats behind = hn::Sub(seen.high_w, all(within.least_w));
  const SeenBounds bounds = widened<Policy>(seen, hn::Mul(behind, all(spread)));
  const Floats aside =
      either(hn::Sub(bounds.high_u, all(within.low_u)), hn::Sub(all(within.high_u), bounds.low_u),
             hn::Sub(bounds.high_v, all(within.low_v)));
  const Floats rest = hn::Sub(all(within.high_v), bounds.low_v);
  if constexpr (Policy::kClosest) {
    return either(aside, hn::Or(behind, rest), hn::Sub(all(within.most_origin_w), bounds.low_w));
  } else {
    return either(aside, behind, rest);
  }
}

/// The state of a unit's groups while its part traverses the hierarchy.
template <class Policy>
class PencilGroups {
 public:
  /// Starts with the groups of the unit before the first test. `spread`: see HullPolicy.
  PencilGroups(PencilUnit& unit, float spread) : unit_(&unit), spread_(spread) {
    for (std::size_t group = 0; group < PencilUnit::kGroups; ++group) {
      if (group < unit_->groups) {
        int rays = 0;
        for (std::size_t i = 0; i < 16; ++i) {
          rays += std::popcount(std::uint32_t{unit_->alive[group * 16 + i]});
        }
        unit_->group_rays[group] = static_cast<float>(rays);
        bound_group(group);
        unit_->group_area[group] = (unit_->group_high_u[group] - unit_->group_low_u[group]) *
                                   (unit_->group_high_v[group] - unit_->group_low_v[group]);
      } else {
        drop_group(group);
      }
    }
    bound_all();
  }

  /// Returns a bit for each group with a ray that may still be hit.
  std::uint32_t alive() const { return unit_->groups_alive; }
  /// Returns the bounds of all rays that may still be hit.
  const PencilBounds& all_bounds() const { return all_; }
  PencilBounds bounds_of(std::size_t group) const {
    return {unit_->group_low_u[group],  unit_->group_high_u[group], unit_->group_low_v[group],
            unit_->group_high_v[group], unit_->group_w[group],      unit_->group_origin_w[group]};
  }

  /// Returns the groups from which bounds may be visible.
  HWY_INLINE std::uint32_t groups_in(const SideBounds& bounds) const {
    std::uint32_t bits = 0;
    for (std::size_t lane = 0; lane < unit_->groups; lane += kLanes) {
      const Floats nearer = hn::Sub(all(bounds[kHighW]), load(&unit_->group_w[lane]));
      const Floats more = widening(nearer);
      Floats out =
          either(hn::Sub(plus(load(&unit_->group_high_u[lane]), more), all(bounds[kLowU])),
                 hn::Sub(plus(all(bounds[kHighU]), more), load(&unit_->group_low_u[lane])),
                 hn::Sub(plus(load(&unit_->group_high_v[lane]), more), all(bounds[kLowV])));
      out = either(out, hn::Sub(plus(all(bounds[kHighV]), more), load(&unit_->group_low_v[lane])),
                   nearer);
      if constexpr (kClosest) {
        out = hn::Or(out, hn::Sub(load(&unit_->group_origin_w[lane]), all(bounds[kLowW])));
      }
      bits |= bits_of(hn::Not(is_negative(out))) << lane;
    }
    return bits;
  }

  /// Returns the blocks of a group from which something within bounds may be visible.
  HWY_INLINE LaneBits blocks_in(std::size_t group, const SideBounds& bounds) const {
    const LaneBits blocks = for_each_register([&](std::size_t lane) {
      const std::size_t at = group * 16 + lane;
      const Floats nearer = hn::Add(load(&unit_->minus_w[at]), all(bounds[kHighW]));
      const Floats more = widening(nearer);
      Floats out = either(hn::Sub(plus(load(&unit_->high_u[at]), more), all(bounds[kLowU])),
                          hn::Add(plus(load(&unit_->minus_low_u[at]), more), all(bounds[kHighU])),
                          hn::Sub(plus(load(&unit_->high_v[at]), more), all(bounds[kLowV])));
      out = either(out, hn::Add(plus(load(&unit_->minus_low_v[at]), more), all(bounds[kHighV])),
                   nearer);
      return hn::Not(is_negative(out));
    });
    return blocks & unit_->group_blocks[group];
  }

  /// Returns by how much shapes are widened (HullPolicy) if their largest w exceeds that of the
  /// rays by `nearer`; 0 if all rays run to one point.
  HWY_INLINE Floats widening(Floats nearer) const { return hn::Mul(nearer, all(spread_)); }
  /// Adds the widening to a value.
  static HWY_INLINE Floats plus(Floats value, Floats more) {
    return Policy::kHull ? hn::Add(value, more) : value;
  }

  float spread() const { return spread_; }

  /// Records which rays of a block were hit. Returns the bit of the block's group if bounds are
  /// affected.
  HWY_INLINE std::uint32_t note(std::size_t place, LaneBits hits) {
    const std::size_t group = place / 16;
    if constexpr (kClosest) {
      const auto found = static_cast<std::uint32_t>(hits != 0);
      changed_blocks_[group] =
          static_cast<std::uint16_t>(changed_blocks_[group] | found << (place % 16));
      return found << group;
    } else {
      const LaneBits alive = unit_->alive[place] & ~hits;
      unit_->alive[place] = static_cast<std::uint16_t>(alive);
      return static_cast<std::uint32_t>(alive == 0) << group;
    }
  }

  /// Recomputes the bounds of the groups for which `note` returned a bit.
  void update(std::uint32_t changed) {
    const std::uint32_t before = unit_->groups_alive;
    bool shrunk = false;
    for (std::uint32_t left = changed & before; left != 0; left &= left - 1) {
      const auto group = static_cast<std::size_t>(std::countr_zero(left));
      if constexpr (kClosest) {
        for (LaneBits blocks = changed_blocks_[group]; blocks != 0; blocks &= blocks - 1) {
          find_farthest(group * 16 + static_cast<std::size_t>(std::countr_zero(blocks)));
        }
        changed_blocks_[group] = 0;
      } else {
        LaneBits dead = 0;
        for (std::size_t i = 0; i < 16; ++i) {
          dead |= static_cast<LaneBits>(unit_->alive[group * 16 + i] == 0) << i;
        }
        dead &= unit_->group_blocks[group];
        for (LaneBits some = dead; some != 0; some &= some - 1) {
          unit_->high_u[group * 16 + static_cast<std::size_t>(std::countr_zero(some))] = -kInfinity;
        }
        unit_->group_blocks[group] = static_cast<std::uint16_t>(unit_->group_blocks[group] & ~dead);
        if (unit_->group_blocks[group] == 0) {
          drop_group(group);
          shrunk = true;
          continue;
        }
      }
      bound_group(group);
    }
    if (kClosest || shrunk) bound_all();
  }

 private:
  static constexpr bool kClosest = Policy::kClosest;

  HWY_INLINE void drop_group(std::size_t group) {
    unit_->group_blocks[group] = 0;
    unit_->group_low_u[group] = unit_->group_low_v[group] = unit_->group_w[group] = kInfinity;
    unit_->group_high_u[group] = unit_->group_high_v[group] = -kInfinity;
    unit_->group_origin_w[group] = -kInfinity;
    unit_->groups_alive &= ~(1U << group);
  }

  HWY_INLINE void bound_group(std::size_t group) {
    const std::size_t first = group * 16;
    Floats low_u = all(-kInfinity), high_u = low_u, low_v = low_u, high_v = low_u, w = low_u,
           origin_w = low_u;
    for (std::size_t lane = 0; lane < 16; lane += kLanes) {
      const Mask in = lanes_of(unit_->group_blocks[group], lane);
      const auto most = [&](Floats& sum, const auto& values) {
        sum = hn::Max(sum, hn::IfThenElse(in, load(&values[first + lane]), all(-kInfinity)));
      };
      most(low_u, unit_->minus_low_u);
      most(high_u, unit_->high_u);
      most(low_v, unit_->minus_low_v);
      most(high_v, unit_->high_v);
      most(w, unit_->minus_w);
      if constexpr (kClosest) most(origin_w, unit_->origin_w_top);
    }
    unit_->group_low_u[group] = -most_of(low_u);
    unit_->group_high_u[group] = most_of(high_u);
    unit_->group_low_v[group] = -most_of(low_v);
    unit_->group_high_v[group] = most_of(high_v);
    unit_->group_w[group] = -most_of(w);
    if constexpr (kClosest) unit_->group_origin_w[group] = most_of(origin_w);
  }

  HWY_INLINE void bound_all() {
    Floats low_u = all(kInfinity), high_u = all(-kInfinity), low_v = low_u, high_v = high_u,
           w = low_u, origin_w = high_u;
    for (std::size_t lane = 0; lane < PencilUnit::kGroups; lane += kLanes) {
      low_u = hn::Min(low_u, load(&unit_->group_low_u[lane]));
      high_u = hn::Max(high_u, load(&unit_->group_high_u[lane]));
      low_v = hn::Min(low_v, load(&unit_->group_low_v[lane]));
      high_v = hn::Max(high_v, load(&unit_->group_high_v[lane]));
      w = hn::Min(w, load(&unit_->group_w[lane]));
      if constexpr (kClosest) origin_w = hn::Max(origin_w, load(&unit_->group_origin_w[lane]));
    }
    all_ = {least_of(low_u), most_of(high_u), least_of(low_v),
            most_of(high_v), least_of(w),     kClosest ? most_of(origin_w) : kInfinity};
  }

  /// Finds the smallest w that hits of a block must exceed.
  HWY_INLINE void find_farthest(std::size_t place) {
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    Floats least = all(kInfinity);
    for (std::size_t lane = 0; lane < PencilUnit::kBlock; lane += kLanes) {
      least = hn::Min(least, hn::IfThenElse(lanes_of(unit_->alive[place], lane),
                                            load(&unit_->w[block + lane]), all(kInfinity)));
    }
    unit_->minus_w[place] = -least_of(least);
  }

  PencilUnit* unit_;
  float spread_;
  PencilBounds all_{};
  std::array<std::uint16_t, PencilUnit::kGroups> changed_blocks_{};  ///< closest hits
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
