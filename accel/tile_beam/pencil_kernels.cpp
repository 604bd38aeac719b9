#include "accel/tile_beam/pencil_kernels.hpp"

#include "accel/core/pick_target.hpp"
#include "accel/tile_beam/pencil_places.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/tile_beam/pencil_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "accel/tile_beam/pencil_grouping-inl.hpp"
#include "accel/tile_beam/pencil_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Returns the largest distance from the apex at which a part is traced together. Beyond a few
/// scene sizes, float rarely distinguishes the origins of rays from nearby surfaces. In any-hit
/// queries, deciding such rays one by one is still worthwhile, except in a scene that is small
/// relative to its coordinates, where all places round to the same values.
template <class Policy>
float farthest(const scenes::Bounds& scene) {
  const float size = scene.largest_coordinate();
  const glm::vec3 extent = scene.extent();
  const float more = !Policy::kClosest
                         ? std::min(8.0F * std::max({extent.x, extent.y, extent.z}), 16.0F * size)
                         : 0.0F;
  return 4.0F * size + more;
}

/// Calls `walk(part, side)` for each side of the cube that the first rays cross, and `undecided(i)`
/// for rays that cross none.
template <class Policy, class Rays, class Walk, class Undecided>
HWY_INLINE AnsweredRays for_each_side(const Rays& pencil, PencilUnit& unit, Walk walk,
                                      Undecided undecided) {
  list_blocks(pencil.rays, pencil.samples, unit);
  const std::size_t count = unit.first[unit.listed];
  PencilPart part{pencil.rays.first(count), pencil.apex, farthest<Policy>(pencil.hierarchy.bounds)};
  if constexpr (Policy::kHull) part.bundle = &pencil;
  std::array<std::uint16_t, PencilUnit::kListed> decided{};
  LaneBits done = 0;
  LaneBits others = LaneBits{1} << unit.side.number;
  while ((others & ~done) != 0) {
    const CubeSide side{std::countr_zero(others & ~done)};
    done |= LaneBits{1} << side.number;
    others |= PencilProjection<Policy>(part, side, unit)();
    for (std::size_t block = 0; block < unit.listed; ++block) {
      decided[block] = static_cast<std::uint16_t>(decided[block] | unit.lanes[block]);
    }
    PencilGrouping(unit, Policy::kClosest)();
    if (unit.places == 0) continue;
    unit.side = side;
    walk(part, side);
  }
  bool some_undecided = false;
  for (std::size_t block = 0; block < unit.listed; ++block) {
    const std::size_t first = unit.first[block];
    const LaneBits present = (LaneBits{1} << (unit.first[block + 1] - first)) - 1;
    for (LaneBits left = ~LaneBits{decided[block]} & present; left != 0; left &= left - 1) {
      undecided(first + static_cast<std::size_t>(std::countr_zero(left)));
      some_undecided = true;
    }
  }
  return {count, some_undecided};
}

template <class Policy, class Counting>
void walk_part(const PencilRays& pencil, const PencilPart& part, CubeSide side, PencilUnit& unit,
               Counting& counting) {
  PencilWalk<Policy, Counting>(pencil.hierarchy, pencil.scene, part, side, unit, counting)();
}

template <class Counting>
AnsweredRays any_hits(const PencilRays& pencil, PencilUnit& unit, std::span<std::uint8_t> hits,
                      Counting& counting) {
  std::ranges::fill(hits.first(std::min(hits.size(), PencilUnit::kRays)), std::uint8_t{0});
  return for_each_side<AnyHitPolicy>(
      pencil, unit,
      [&](const PencilPart& part, CubeSide side) {
        counting.add("beams");
        walk_part<AnyHitPolicy>(pencil, part, side, unit, counting);
        for (std::size_t place = 0; place < unit.places; ++place) {
          const std::size_t block = unit.slot[place];
          LaneBits hit = unit.lanes[block] & ~LaneBits{unit.alive[place]};
          for (; hit != 0; hit &= hit - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(hit));
            hits[unit.ray_at(block * PencilUnit::kBlock + lane)] = 1;
          }
        }
      },
      [&](std::size_t i) { hits[i] = kUndecided; });
}

template <class Counting>
AnsweredRays bundle(const BundleRays& rays, PencilUnit& unit, std::span<std::uint32_t> found,
                    Counting& counting) {
  return for_each_side<HullPolicy>(
      rays, unit,
      [&](const PencilPart& part, CubeSide side) {
        std::fill_n(unit.hidden.begin(), unit.places * PencilUnit::kBlock, std::uint16_t{0});
        std::fill_n(unit.tests.begin(), unit.places * PencilUnit::kBlock, std::uint8_t{0});
        walk_part<HullPolicy>(rays, part, side, unit, counting);
        for (std::size_t place = 0; place < unit.places; ++place) {
          const std::size_t block = unit.slot[place] * PencilUnit::kBlock;
          for (LaneBits left = unit.lanes[unit.slot[place]]; left != 0; left &= left - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(left));
            const std::uint32_t hidden = unit.hidden[place * PencilUnit::kBlock + lane];
            const bool is_alive = (unit.alive[place] >> lane & 1U) != 0;
            found[unit.ray_at(block + lane)] =
                is_alive || hidden == rays.all_apexes() ? hidden : kOpen;
          }
        }
      },
      [&](std::size_t i) { found[i] = kOpen; });
}

template <class Counting>
AnsweredRays closest_hits(const PencilRays& pencil, PencilUnit& unit, const HitSpan& buffer,
                          std::size_t first, Counting& counting) {
  float* const t = buffer.t() + first;
  scenes::PrimitiveId* const primitive = buffer.primitive() + first;
  bool some_missed = false;
  AnsweredRays answered = for_each_side<ClosestHitPolicy>(
      pencil, unit,
      [&](const PencilPart& part, CubeSide side) {
        counting.add("beams");
        walk_part<ClosestHitPolicy>(pencil, part, side, unit, counting);
        const auto z = static_cast<int>(side.z_axis());
        // The position of a hit is off by up to 8 roundings of its distance from the apex. If this
        // exceeds the 16 roundings allowed for origin and hit (`float_unit`), the canonical test
        // determines t.
        const auto is_far = [](const Ray& ray, float t, float depth) {
          const float more = depth - 2.0F * glm::length(ray.origin);
          if (more <= 0.0F) return false;
          const glm::vec3 size = glm::abs(ray.origin + t * ray.direction);
          return more > 2.0F * std::max({size.x, size.y, size.z});
        };
        for (std::size_t place = 0; place < unit.places; ++place) {
          const std::size_t block = unit.slot[place];
          for (LaneBits left = unit.lanes[block]; left != 0; left &= left - 1) {
            const std::size_t at =
                block * PencilUnit::kBlock + static_cast<std::size_t>(std::countr_zero(left));
            const std::size_t i = unit.ray_at(at);
            const float depth = 1.0F / unit.w[at];
            const bool hit = unit.w[at] > 0.0F;
            const Ray& ray = pencil.rays[i];
            primitive[i] = hit ? unit.primitive[at] : scenes::kNoPrimitive;
            // For a hit at the ray's origin, the depths may differ by a rounding.
            const float from_origin = std::max(depth - 1.0F / unit.origin_w[at], 0.0F);
            t[i] = hit ? from_origin / std::abs(ray.direction[z]) : kInfinity;
            if (hit && is_far(ray, t[i], depth)) [[unlikely]] {
              const float exact = intersect(CanonicalRay(ray), pencil.scene, primitive[i]);
              t[i] = is_hit(exact) ? exact : kUndecidedT;
              some_missed = some_missed || !is_hit(exact);
              counting.add_tests(pencil.scene.primitives[primitive[i]].kind);
            }
          }
        }
      },
      [&](std::size_t i) { t[i] = kUndecidedT; });
  answered.some_undecided = answered.some_undecided || some_missed;
  return answered;
}

void places_of(const PencilRays& pencil, PencilUnit& unit, std::span<BeamPlace> places) {
  for_each_side<AnyHitPolicy>(
      pencil, unit,
      [&](const PencilPart& part, CubeSide side) {
        HandOverRecorder recorder(PencilUnit::kBlocks * PencilUnit::kBlock);
        walk_part<AnyHitPolicy>(pencil, part, side, unit, recorder);
        note_places(unit, side, recorder, places);
      },
      [](std::size_t) {});
}

template <class Counting>
constexpr PencilQueries<Counting> pencil_queries() {
  return {any_hits<Counting>, closest_hits<Counting>, bundle<Counting>};
}

inline std::size_t count_part(const PencilRays& pencil, PencilUnit& unit) {
  list_blocks(pencil.rays, pencil.samples, unit);
  return unit.first[unit.listed];
}

const PencilKernels& pencil_kernels() {
  static constexpr PencilKernels kKernels{pencil_queries<NoCounting>(),
                                          pencil_queries<WorkCounters>(), count_part, places_of};
  return kKernels;
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::accel::tile_beam {

HWY_EXPORT(pencil_kernels);

const PencilKernels& pencil_kernels_for(std::int64_t targets) {
  return pick_target(HWY_DISPATCH_TABLE(pencil_kernels), targets)();
}

}  // namespace beambench::accel::tile_beam
#endif
