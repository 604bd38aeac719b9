// The rays of a stream: copied for it, and loaded into lanes from scattered places, for the
// instruction set being compiled.

#if defined(ACCEL_BVH_STREAM_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_BVH_STREAM_ROWS_INL
#undef ACCEL_BVH_STREAM_ROWS_INL
#else
#define ACCEL_BVH_STREAM_ROWS_INL
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include <hwy/highway.h>

#include "accel/bvh/box_quads.hpp"
#include "accel/bvh/stream_tests-inl.hpp"
#include "accel/core/ray.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

/// The places of a stream's rays, relative to the tree's center.
struct RowsExtent {
  glm::vec3 middle;  ///< the mean of origins
  glm::vec3 lower;   ///< the box about the rays from origin to end, if requested
  glm::vec3 upper;
};

/// Copies rays for a stream: without zeros in directions, with finite ends. Rays that no stream can
/// trace (stream_tests-inl.hpp) end before they begin.
template <bool kWithBox>
RowsExtent fill_rows(std::span<const Ray> rays, const StreamTree& tree, Ray* rows) {
  // Four floats at once: origin and t_min, direction and t_max.
  const auto load_quad = [](const float* from) {
    Quad quad;
    std::memcpy(&quad, from, sizeof quad);
    return quad;
  };
  const auto size_of = [](Quad quad) { return quad < quad_of(0.0F) ? -quad : quad; };
  const Quad center = quad_of(tree.center);
  const Quad none = quad_of(0.0F);
  constexpr float kTiny = 1e-18F;
  const Quad tiny{kTiny, kTiny, kTiny, 0.0F};
  const Quad largest{kInfinity, kInfinity, kInfinity, std::numeric_limits<float>::max()};
  const float farthest = 4.0F * tree.half_size;
  Quad sum = none;
  QuadBox box = QuadBox::empty();
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Quad origin = load_quad(&rays[i].origin.x);
    Quad direction = smaller(load_quad(&rays[i].direction.x), largest);
    const Quad size = size_of(direction);
    direction = size < tiny ? (direction < none ? -tiny : tiny) : direction;
    const Quad from_center = origin - center;
    const Quad distance = size_of(from_center);
    const float length = std::max(std::max(size[0], size[1]), size[2]);
    const float farness = std::max(std::max(distance[0], distance[1]), distance[2]);
    std::memcpy(&rows[i].origin.x, &origin, sizeof origin);
    std::memcpy(&rows[i].direction.x, &direction, sizeof direction);
    if (!(farness <= farthest && length >= 0x1p-20F && length <= 0x1p20F)) {
      rows[i].t_max = -1.0F;
      continue;
    }
    sum += from_center;
    ++count;
    if constexpr (kWithBox) {
      box.include(from_center);
      box.include(from_center + direction * quad_of(direction[3]));
    }
  }
  const Quad mean = sum / quad_of(static_cast<float>(std::max(count, std::size_t{1})));
  RowsExtent extent{{mean[0], mean[1], mean[2]}, {}, {}};
  // The ends are rounded; where that is far from the scene, it does not matter.
  const Quad wider = quad_of(0x1p-18F * tree.half_size);
  const scenes::Bounds bounds = QuadBox{box.lower - wider, box.upper + wider}.bounds();
  extent.lower = bounds.lower;
  extent.upper = bounds.upper;
  return extent;
}

// A ray is two rows of four floats: origin and t_min, direction and t_max.
static_assert(sizeof(Ray) == 8 * sizeof(float));

// Lists name rays by the places of their rows, in bytes.

inline std::uint32_t place_of(std::size_t i) { return static_cast<std::uint32_t>(i * sizeof(Ray)); }
inline std::size_t ray_at(std::uint32_t place) { return place / sizeof(Ray); }
HWY_INLINE const Ray& row_at(const Ray* rows, std::uint32_t place) {
  return *reinterpret_cast<const Ray*>(reinterpret_cast<const char*>(rows) + place);
}
HWY_INLINE Ray& row_at(Ray* rows, std::uint32_t place) {
  return *reinterpret_cast<Ray*>(reinterpret_cast<char*>(rows) + place);
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
