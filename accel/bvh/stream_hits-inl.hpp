// The hits of a stream: guessed in float, decided by the canonical tests, for the instruction set
// being compiled.

#if defined(ACCEL_BVH_STREAM_HITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_BVH_STREAM_HITS_INL
#undef ACCEL_BVH_STREAM_HITS_INL
#else
#define ACCEL_BVH_STREAM_HITS_INL
#endif

#include <algorithm>
#include <array>
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

/// A likely hit of a triangle in float is a guess: it ends the ray, or shortens it to the guess,
/// and in the end the canonical test runs once for the best guess of each ray, several rays at
/// once. Possible hits that are not likely, and likely ones that may be as near as the best, are
/// confirmed as well: they are doubts. A ray whose guess no canonical test confirms is left to be
/// traced alone, so that results do not depend on guesses.
///
/// Rays are named by the places of their rows, which hold the t_max that remains.
template <bool kAny, class Counting>
class StreamHits {
 public:
  static constexpr float kEnded = -1.0F;  ///< t_max of rays that need no more hits

  StreamHits(const Stream& stream, StreamMemory& memory, Counting& counting)
      : stream_(stream),
        rows_(memory.rows.data()),
        guesses_(memory.guesses.data()),
        doubts_(memory.doubts),
        counting_(counting) {
    const std::size_t count = stream.rays.size();
    std::fill_n(guesses_, count, StreamGuess{});
    doubts_.clear();
    if constexpr (kAny) {
      std::fill_n(stream_.any, count, std::uint8_t{0});
    } else {
      std::fill_n(stream_.t, count, kInfinity);
      std::fill_n(stream_.primitive, count, scenes::kNoPrimitive);
    }
  }

  /// Fetches a ray's guess into the caches.
  HWY_INLINE void prefetch(std::uint32_t place) const { hwy::Prefetch(&guesses_[ray_at(place)]); }

  /// Notes a likely hit before `t_high`. Of two that may be equally near, both are confirmed.
  HWY_INLINE void presume(std::uint32_t place, const StreamGuess& guess, float t_high) {
    StreamGuess& best = guesses_[ray_at(place)];
    if (guess.t_low > row(place).t_max) return;
    if (kAny || t_high < best.t_low) {
      best = guess;
    } else {
      doubt(place, guess.triangle);
    }
    row(place).t_max = std::min(row(place).t_max, t_high);
  }

  /// Notes a possible hit.
  void doubt(std::uint32_t place, std::uint32_t triangle) {
    doubts_.push_back({static_cast<std::uint32_t>(ray_at(place)), triangle});
    if (doubts_.size() < kMostDoubts) return;
    confirm_all(doubts_);
    doubts_.clear();
  }

  /// Decides a sphere or a cone at once.
  void confirm(std::uint32_t place, scenes::PrimitiveId id) {
    counting_.add("confirmed_tests");
    const std::size_t i = ray_at(place);
    const float t = intersect(CanonicalRay(stream_.rays[i]), stream_.scene, id);
    if (is_hit(t)) keep(i, t, id);
  }

  /// Runs the canonical tests of all guesses and doubts.
  HWY_NOINLINE void confirm_guesses() {
    std::array<StreamPair, kMostDoubts> pairs;
    std::size_t size = 0;
    for (std::size_t i = 0; i < stream_.rays.size(); ++i) {
      pairs[size] = {static_cast<std::uint32_t>(i), guesses_[i].triangle};
      size += guesses_[i].triangle != kNoTriangle ? 1 : 0;
      if (size < pairs.size()) continue;
      confirm_all(pairs);
      size = 0;
    }
    confirm_all(std::span(pairs).first(size));
    confirm_all(doubts_);
  }

  /// Appends the rays whose guesses were wrong, and those that no stream can trace.
  void append_undecided(std::vector<std::uint32_t>& left) const {
    const std::span<const Ray> rays = stream_.rays;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool was_cut = rows_[i].t_max < finite(rays[i].t_max);
      const bool found = kAny ? stream_.any[i] != 0 : stream_.t[i] <= rows_[i].t_max;
      // One branch, which is almost never taken.
      if ((was_cut & !found) != 0) left.push_back(static_cast<std::uint32_t>(i));
    }
  }

 private:
  static constexpr std::size_t kMostDoubts = 256;

  /// Keeps a confirmed hit if it precedes the best, and shortens its ray.
  HWY_INLINE void keep(std::size_t i, float t, scenes::PrimitiveId id) {
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

  void confirm_all(std::span<const StreamPair> pairs) {
    counting_.add("confirmed_tests", pairs.size());
    while (!pairs.empty()) {
      constexpr std::size_t kAhead = 4 * kDoubleLanes;
      for (std::size_t i = kAhead; i < std::min(kAhead + kDoubleLanes, pairs.size()); ++i) {
        prefetch_lines(stream_.bvh.blocks[pairs[i].triangle / kBvhLanes]);
      }
      const std::size_t count = std::min(kDoubleLanes, pairs.size());
      confirm_some(pairs.first(count));
      pairs = pairs.subspan(count);
    }
  }

  /// As many pairs as there are lanes, or fewer.
  HWY_INLINE void confirm_some(std::span<const StreamPair> some) {
    RayTrianglePairs pairs;
    std::array<scenes::PrimitiveId, kDoubleLanes> ids;
    const auto put = [](RayTrianglePairs::Point& point, std::size_t lane, const glm::vec3& v) {
      point.x[lane] = v.x;
      point.y[lane] = v.y;
      point.z[lane] = v.z;
    };
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
      const auto [i, triangle] = some[std::min(lane, some.size() - 1)];
      const Ray& ray = stream_.rays[i];
      const PrimitiveBlock& block = stream_.bvh.blocks[triangle / kBvhLanes];
      ids[lane] = block.primitives[triangle % kBvhLanes];
      put(pairs.origin, lane, ray.origin);
      put(pairs.direction, lane, ray.direction);
      for (std::size_t which = 0; which < 3; ++which) {
        put(pairs.corners[which], lane, block.corner(which, triangle % kBvhLanes));
      }
    }
    alignas(64) std::array<double, kDoubleLanes> t;
    intersect_triangles(pairs, t.data());
    for (std::size_t lane = 0; lane < some.size(); ++lane) {
      const std::size_t i = some[lane].ray;
      const Ray& ray = stream_.rays[i];
      const float accepted = accept(t[lane], ray.t_min, finite(ray.t_max));
      if (is_hit(accepted)) keep(i, accepted, ids[lane]);
    }
  }

  Ray& row(std::uint32_t place) const { return row_at(rows_, place); }

  const Stream& stream_;
  Ray* rows_;
  StreamGuess* guesses_;
  std::vector<StreamPair>& doubts_;
  Counting& counting_;
};

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
