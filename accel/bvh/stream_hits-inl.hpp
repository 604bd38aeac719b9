// The hits of a stream: found in float if certain, otherwise decided by the canonical tests, for
// the instruction set being compiled.

#if defined(ACCEL_BVH_STREAM_HITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_BVH_STREAM_HITS_INL
#undef ACCEL_BVH_STREAM_HITS_INL
#else
#define ACCEL_BVH_STREAM_HITS_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "accel/bvh/stream_kernels.hpp"
#include "accel/bvh/stream_memory.hpp"
#include "accel/bvh/stream_rows-inl.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/intersect_triangles-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

template <class Object>
HWY_INLINE void prefetch_lines(const Object& object) {
  const auto* bytes = reinterpret_cast<const char*>(&object);
  for (std::size_t at = 0; at < sizeof(Object); at += 64) hwy::Prefetch(bytes + at);
}

/// A hit of a triangle that is certain in float (`TriangleLanes`) ends its ray, or shortens it. At
/// the end, t is computed as in the canonical test, once per ray, for several rays at a time.
/// Possible hits that are not certain, and certain hits that may tie with the nearest, become
/// doubts, which the canonical test decides.
///
/// Rays are identified by the offsets of their rows, which hold the remaining t_max.
template <bool kAny, class Counting>
class StreamHits {
 public:
  static constexpr float kEnded = -1.0F;  ///< t_max of rays that need no more hits

  StreamHits(const Stream& stream, StreamMemory& memory, Counting& counting)
      : stream_(stream),
        rows_(memory.rows.data()),
        hits_(memory.hits.data()),
        doubts_(memory.doubts),
        counting_(counting) {
    const std::size_t count = stream.rays.size();
    doubts_.clear();
    if constexpr (kAny) {
      std::fill_n(stream_.any, count, std::uint8_t{0});
    } else {
      std::fill_n(hits_, count, StreamHit{});
      std::fill_n(stream_.t, count, kInfinity);
      std::fill_n(stream_.primitive, count, scenes::kNoPrimitive);
    }
  }

  /// Ends a ray that certainly hits something.
  HWY_INLINE void end(std::uint32_t place) requires kAny {
    stream_.any[ray_at(place)] = 1;
    row(place).t_max = kEnded;
  }

  /// Keeps a certain hit before `t_high`. Of two hits that may tie, one becomes a doubt.
  HWY_INLINE void keep(std::uint32_t place, const StreamHit& hit, float t_high) requires(!kAny) {
    Ray& ray = row(place);
    StreamHit& nearest = hits_[ray_at(place)];
    if (t_high < nearest.t_low) {
      nearest = hit;
    } else {
      doubt(place, hit.triangle);
    }
    ray.t_max = std::min(ray.t_max, t_high);
  }

  /// Notes a possible hit.
  HWY_NOINLINE void doubt(std::uint32_t place, std::uint32_t triangle) {
    doubts_.push_back({static_cast<std::uint32_t>(ray_at(place)), triangle});
    if (doubts_.size() == kMostDoubts) decide_doubts();
  }

  /// Decides a sphere or a cone at once.
  void decide(std::uint32_t place, scenes::PrimitiveId id) {
    counting_.add("confirmed_tests");
    const std::size_t i = ray_at(place);
    const float t = intersect(CanonicalRay(stream_.rays[i]), stream_.scene, id);
    if (is_hit(t)) write(i, t, id);
  }

  /// Decides all doubts and computes t of all certain hits.
  HWY_NOINLINE void finish() {
    decide_doubts();
    if constexpr (!kAny) {
      // The last rays may be written twice: there are at least as many rays as lanes.
      const std::size_t last = stream_.rays.size() - kDoubleLanes;
      for (std::size_t i = 0; i < last; i += kDoubleLanes) write_certain(i);
      write_certain(last);
    }
  }

 private:
  static constexpr std::size_t kMostDoubts = 256;
  /// Lanes of float, one for each lane of double.
  using PairTag = RayTrianglePairs::Tag;

  HWY_NOINLINE void decide_doubts() {
    counting_.add("confirmed_tests", doubts_.size());
    for (std::size_t i = 0; i < doubts_.size(); i += kDoubleLanes) {
      const std::size_t count = std::min(kDoubleLanes, doubts_.size() - i);
      const auto pair = [&](std::size_t lane) { return doubts_[i + std::min(lane, count - 1)]; };
      hn::Vec<PairTag> polygons;
      const RayTrianglePairs pairs =
          paired([&](std::size_t lane) { return pair(lane).ray; },
                 [&](std::size_t lane) { return pair(lane).triangle; }, polygons);
      alignas(64) std::array<double, kDoubleLanes> t;
      intersect_triangles(pairs, t.data());
      for (std::size_t lane = 0; lane < count; ++lane) {
        const auto [ray, triangle] = pair(lane);
        const auto& [origin, t_min, direction, t_max] = stream_.rays[ray];
        const float accepted = accept(t[lane], t_min, finite(t_max));
        if (is_hit(accepted)) write(ray, accepted, stream_.tree.triangles[triangle].polygon);
      }
    }
    doubts_.clear();
  }

  /// Writes the certain hits of one ray per lane, from `first` on, if they precede those already
  /// written.
  HWY_INLINE void write_certain(std::size_t first) {
    alignas(64) std::array<std::uint32_t, kDoubleLanes> numbers;
    std::uint64_t hits = 0;
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
      const std::uint32_t number = hits_[first + lane].triangle;
      const bool is_hit = number != kNoTriangle;
      numbers[lane] = is_hit ? number : 0;
      hits |= std::uint64_t{is_hit} << lane;
    }
    if (hits == 0) return;
    const PairTag floats;
    const hn::RebindToUnsigned<PairTag> words;
    hn::Vec<PairTag> polygons;
    const RayTrianglePairs pairs =
        paired([&](std::size_t lane) { return first + lane; },
               [&](std::size_t lane) { return numbers[lane]; }, polygons);
    // The rounding is the same as in `accept`.
    const auto t = hn::Add(hn::DemoteTo(floats, distances_along_rays(pairs)), hn::Zero(floats));
    const auto polygon = hn::BitCast(words, polygons);
    const auto old_t = hn::LoadU(floats, stream_.t + first);
    const auto old_polygon = hn::LoadU(words, stream_.primitive + first);
    const auto is_lower = hn::RebindMask(floats, hn::Lt(polygon, old_polygon));
    const auto precedes =
        hn::And(hn::LoadMaskBits(floats, reinterpret_cast<const std::uint8_t*>(&hits)),
                hn::Or(hn::Lt(t, old_t), hn::And(hn::Eq(t, old_t), is_lower)));
    hn::StoreU(hn::IfThenElse(precedes, t, old_t), floats, stream_.t + first);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(words, precedes), polygon, old_polygon), words,
               stream_.primitive + first);
  }

  /// Writes a hit if it precedes the best, and shortens its ray.
  HWY_INLINE void write(std::size_t i, float t, scenes::PrimitiveId id) {
    if constexpr (kAny) {
      stream_.any[i] = 1;
      rows_[i].t_max = kEnded;
    } else {
      if (!precedes({t, id}, {stream_.t[i], stream_.primitive[i]})) return;
      stream_.t[i] = t;
      stream_.primitive[i] = id;
      rows_[i].t_max = std::min(rows_[i].t_max, t);
    }
  }

  /// Returns pairs of the rays and the triangles with the numbers `ray(lane)` and `triangle(lane)`,
  /// and sets the triangles' polygons.
  template <class RayNumber, class TriangleNumber>
  HWY_INLINE RayTrianglePairs paired(const RayNumber& ray, const TriangleNumber& triangle,
                                     hn::Vec<PairTag>& polygons) const {
    const auto points = [](const auto& row, hn::Vec<PairTag>& fourth) -> RayTrianglePairs::Point {
      Triple<PairTag> point;
      load_transposed(PairTag(), row, point, fourth);
      return {point.x, point.y, point.z};
    };
    const auto ray_at = [&](std::size_t lane) -> const Ray& { return stream_.rays[ray(lane)]; };
    const auto whole = [&](std::size_t lane) -> const WholeTriangle& {
      return stream_.tree.triangles[triangle(lane)];
    };
    hn::Vec<PairTag> unused;
    return {points([&](std::size_t lane) { return &ray_at(lane).origin.x; }, unused),
            points([&](std::size_t lane) { return &ray_at(lane).direction.x; }, unused),
            {points([&](std::size_t lane) { return &whole(lane).a.x; }, polygons),
             points([&](std::size_t lane) { return &whole(lane).b.x; }, unused),
             points([&](std::size_t lane) { return &whole(lane).c.x; }, unused)}};
  }

  Ray& row(std::uint32_t place) const { return row_at(rows_, place); }

  const Stream& stream_;
  Ray* rows_;
  StreamHit* hits_;
  std::vector<StreamPair>& doubts_;
  Counting& counting_;
};

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
