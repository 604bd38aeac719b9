// The rays of a stream: copied for it, and loaded into lanes from scattered places, for the
// instruction set being compiled.

#if defined(ACCEL_BVH_STREAM_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_BVH_STREAM_ROWS_INL
#undef ACCEL_BVH_STREAM_ROWS_INL
#else
#define ACCEL_BVH_STREAM_ROWS_INL
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hwy/highway.h>

#include "accel/bvh/stream_tests-inl.hpp"
#include "accel/core/canonical_ray.hpp"
#include "accel/core/ray.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

/// Copies rays for a stream: without zeros in directions, with finite ends. Rays that no stream can
/// trace (stream_tests-inl.hpp) end before they begin. Returns the mean of the others' origins,
/// relative to the center.
inline glm::vec3 fill_rows(std::span<const Ray> rays, const StreamTree& tree, Ray* rows) {
  const float farthest = 4.0F * tree.half_size;
  const auto without_zero = [](float component) {
    constexpr float kTiny = 1e-18F;
    return std::abs(component) < kTiny ? std::copysign(kTiny, component) : component;
  };
  const auto largest_of = [](const glm::vec3& v) {
    return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::abs(v.z));
  };
  glm::vec3 sum(0.0F);
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::vec3& direction = rays[i].direction;
    Ray& row = rows[i];
    row.origin = rays[i].origin;
    row.t_min = rays[i].t_min;
    row.direction = {without_zero(direction.x), without_zero(direction.y),
                     without_zero(direction.z)};
    const glm::vec3 from_center = row.origin - tree.center;
    const float length = largest_of(direction);
    const bool can_stream =
        largest_of(from_center) <= farthest && length >= 0x1p-20F && length <= 0x1p20F;
    row.t_max = can_stream ? finite(rays[i].t_max) : -1.0F;
    sum += can_stream ? from_center : glm::vec3(0.0F);
    count += can_stream ? 1 : 0;
  }
  return sum / static_cast<float>(std::max(count, std::size_t{1}));
}

// A ray is two rows of four floats: origin and t_min, direction and t_max.
static_assert(sizeof(Ray) == 8 * sizeof(float));

HWY_INLINE const Ray& row_at(const Ray* rows, std::uint32_t place) {
  return *reinterpret_cast<const Ray*>(reinterpret_cast<const char*>(rows) + place);
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE LaneRays<Tag> load_rays(const Ray* rows, const std::uint32_t* places) {
  const Ray& ray = row_at(rows, places[0]);
  const auto point = [](const glm::vec3& v) -> Triple<Tag> {
    return {all(v.x), all(v.y), all(v.z)};
  };
  return {point(ray.origin), all(ray.t_min), point(ray.direction), all(ray.t_max)};
}

#else

/// Loads a half of rays i, i + 4, i + 8 ...: origins and t_min (0), or directions and t_max (1).
template <class D>
HWY_INLINE hn::Vec<D> load_halves(D d, const Ray* rows, const std::uint32_t* places,
                                  std::size_t half) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(d, &row_at(rows, places[0]).origin.x + 4 * half);
  } else {
    const hn::Half<D> fewer;
    return hn::Combine(d, load_halves(fewer, rows, places + hn::MaxLanes(fewer), half),
                       load_halves(fewer, rows, places, half));
  }
}

/// Loads as many rays as there are lanes, from places in bytes.
HWY_INLINE LaneRays<Tag> load_rays(const Ray* rows, const std::uint32_t* places) {
  const hn::Repartition<double, Tag> pairs;
  const auto transposed = [&](std::size_t half, Triple<Tag>& point, Floats& fourth) {
    const Floats a = load_halves(Tag(), rows, places, half);
    const Floats b = load_halves(Tag(), rows, places + 1, half);
    const Floats c = load_halves(Tag(), rows, places + 2, half);
    const Floats d = load_halves(Tag(), rows, places + 3, half);
    const auto xy_0 = hn::BitCast(pairs, hn::InterleaveLower(Tag(), a, b));
    const auto xy_1 = hn::BitCast(pairs, hn::InterleaveLower(Tag(), c, d));
    const auto zw_0 = hn::BitCast(pairs, hn::InterleaveUpper(Tag(), a, b));
    const auto zw_1 = hn::BitCast(pairs, hn::InterleaveUpper(Tag(), c, d));
    point.x = hn::BitCast(Tag(), hn::InterleaveLower(pairs, xy_0, xy_1));
    point.y = hn::BitCast(Tag(), hn::InterleaveUpper(pairs, xy_0, xy_1));
    point.z = hn::BitCast(Tag(), hn::InterleaveLower(pairs, zw_0, zw_1));
    fourth = hn::BitCast(Tag(), hn::InterleaveUpper(pairs, zw_0, zw_1));
  };
  LaneRays<Tag> rays;
  transposed(0, rays.origin, rays.t_min);
  transposed(1, rays.direction, rays.t_max);
  return rays;
}

#endif

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
