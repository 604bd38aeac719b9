// The rays of a part of a pencil that are traced singly.

#if defined(ACCEL_TILE_BEAM_PENCIL_SINGLE_RAYS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_SINGLE_RAYS_INL
#undef ACCEL_TILE_BEAM_PENCIL_SINGLE_RAYS_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_SINGLE_RAYS_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "accel/core/ray.hpp"
#include "accel/tile_beam/hand_over.hpp"
#include "accel/tile_beam/pencil_groups-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"
#include "accel/tile_beam/ray_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Traces rays singly by the same query and records their hits with those of the part.
template <class Policy, class Counting>
class PencilSingleRays {
 public:
  PencilSingleRays(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                   const PencilPart& part, const ApexView& view, PencilUnit& unit,
                   PencilGroups<Policy>& groups, Counting& counting)
      : hierarchy_(&hierarchy),
        scene_(&scene),
        part_(&part),
        view_(&view),
        unit_(&unit),
        groups_(&groups),
        counting_(&counting) {}

  /// Traces the rays of some groups whose places are within bounds through a part of the hierarchy.
  /// Returns the groups that changed. For a bundle, marks the rays' origins as open instead.
  std::uint32_t hand_over(TileChild from, const SideBounds& bounds, std::uint32_t groups) {
    count_ = 0;
    for (; groups != 0; groups &= groups - 1) {
      const auto group = static_cast<std::size_t>(std::countr_zero(groups));
      for (LaneBits blocks = groups_->blocks_in(group, bounds); blocks != 0; blocks &= blocks - 1) {
        list_within(bounds, group * 16 + static_cast<std::size_t>(std::countr_zero(blocks)));
      }
    }
    if constexpr (Policy::kHull) {
      std::fill_n(is_hit_.begin(), count_, std::uint8_t{1});
    } else {
      trace_listed(from);
    }
    std::uint32_t changed = 0;
    for (std::size_t i = 0; i < count_;) {
      const std::size_t place = listed_[i] / PencilUnit::kBlock;
      LaneBits hits = 0;
      for (; i < count_ && listed_[i] / PencilUnit::kBlock == place; ++i) {
        hits |= LaneBits{is_hit_[i]} << listed_[i] % PencilUnit::kBlock;
      }
      changed |= groups_->note(place, hits);
    }
    return changed;
  }

  /// Returns whether the ray at a place in the unit hits anything in the hierarchy.
  bool is_hit(std::size_t at) const {
    note_handed_over(*counting_, at);
    return any_below(*hierarchy_, *scene_, hierarchy_->root, part_->rays[unit_->ray_at(at)],
                     *counting_);
  }

  /// Keeps a closest hit if it is the nearest so far, and returns whether it is.
  bool keeps(std::size_t at, const Ray& ray, const Hit& hit) {
    const auto z = static_cast<int>(view_->side.z_axis());
    const float origin = (ray.origin[z] - view_->apex[z]) * view_->side.sign();
    const float w = 1.0F / (origin + hit.t * ray.direction[z] * view_->side.sign());
    if (!(w > unit_->w[at])) return false;
    unit_->w[at] = w;
    unit_->primitive[at] = hit.primitive;
    return true;
  }

 private:
  static constexpr bool kClosest = Policy::kClosest;

  std::size_t at(std::size_t i) const {
    return unit_->slot[listed_[i] / PencilUnit::kBlock] * PencilUnit::kBlock +
           listed_[i] % PencilUnit::kBlock;
  }

  void list_within(const SideBounds& bounds, std::size_t place) {
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    LaneBits inside = for_each_register([&](std::size_t lane) {
      const std::size_t at = block + lane;
      const Floats more = groups_->widening(hn::Sub(all(bounds[kHighW]), load(&unit_->w[at])));
      const auto within = [&](Floats value, float low, float high) {
        const auto plus = PencilGroups<Policy>::plus;
        return hn::And(hn::Ge(plus(value, more), all(low - kPlacePad)),
                       hn::Le(value, plus(all(high + kPlacePad), more)));
      };
      return hn::And(hn::And(within(load(&unit_->u[at]), bounds[kLowU], bounds[kHighU]),
                             within(load(&unit_->v[at]), bounds[kLowV], bounds[kHighV])),
                     hn::Le(load(&unit_->w[at]), all(bounds[kHighW])));
    });
    inside &= unit_->alive[place];
    for (; inside != 0; inside &= inside - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(inside));
      listed_[count_] = static_cast<std::uint16_t>(place * PencilUnit::kBlock + lane);
      is_hit_[count_] = 0;
      ++count_;
    }
  }

  void trace_listed(TileChild from) {
    std::size_t following = 0;
    const auto next = [&](Ray& ray, std::size_t& i) {
      if (following == count_) return false;
      i = following++;
      note_handed_over(*counting_, at(i));
      ray = part_->rays[unit_->ray_at(at(i))];
      return true;
    };
    if constexpr (kClosest) {
      answer_rays_below<ClosestQuery>(
          *hierarchy_, *scene_, from, *counting_, next,
          [&](std::size_t i, const std::optional<Hit>& hit) {
            is_hit_[i] = hit && keeps(at(i), part_->rays[unit_->ray_at(at(i))], *hit) ? 1 : 0;
          });
    } else {
      answer_rays_below<AnyQuery>(*hierarchy_, *scene_, from, *counting_, next,
                                  [&](std::size_t i, bool hit) { is_hit_[i] = hit ? 1 : 0; });
    }
  }

  /// The maximum error of the bounds of boxes and of places: a few roundings of places |u| <= 1.
  static constexpr float kPlacePad = 3e-7F;
  static constexpr std::size_t kMax = PencilUnit::kPlaces * PencilUnit::kBlock;

  const TileHierarchy* hierarchy_;
  const scenes::Scene* scene_;
  const PencilPart* part_;
  const ApexView* view_;
  PencilUnit* unit_;
  PencilGroups<Policy>* groups_;
  Counting* counting_;
  std::size_t count_ = 0;
  std::array<std::uint16_t, kMax> listed_;  ///< places and lanes of the rays to be traced
  std::array<std::uint8_t, kMax> is_hit_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
