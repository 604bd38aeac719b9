// Copies the rays of a stream, and loads them into lanes from scattered places, for the instruction
// set being compiled.

#if defined(ACCEL_BVH_STREAM_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_BVH_STREAM_ROWS_INL
#undef ACCEL_BVH_STREAM_ROWS_INL
#else
#define ACCEL_BVH_STREAM_ROWS_INL
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include <hwy/highway.h>

#include "accel/bvh/box_quads.hpp"
#include "accel/bvh/stream_tests-inl.hpp"
#include "accel/core/ray.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

/// The places of a stream's rays, relative to the tree's center.
struct RowsExtent {
  glm::vec3 middle;  ///< the mean origin
  glm::vec3 lower;   ///< the box of the rays from origin to end, if requested
  glm::vec3 upper;
};

/// Copies rays for a stream, replacing zeros in directions and infinite ends. Rays that no stream
/// can trace (stream_tests-inl.hpp) get an empty interval and are appended to `left`.
template <bool kWithBox>
RowsExtent fill_rows(std::span<const Ray> rays, const StreamTree& tree, Ray* rows,
                     std::vector<std::uint32_t>& left) {
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
      left.push_back(static_cast<std::uint32_t>(i));
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
  // The ends are rounded; far from the scene, this does not matter.
  const Quad wider = quad_of(0x1p-18F * tree.half_size);
  const scenes::Bounds bounds = QuadBox{box.lower - wider, box.upper + wider}.bounds();
  extent.lower = bounds.lower;
  extent.upper = bounds.upper;
  return extent;
}

// A ray is two rows of four floats: origin and t_min, direction and t_max.
static_assert(sizeof(Ray) == 8 * sizeof(float));

// Lists identify rays by the offsets of their rows, in bytes.

inline std::uint32_t place_of(std::size_t i) { return static_cast<std::uint32_t>(i * sizeof(Ray)); }
inline std::size_t ray_at(std::uint32_t place) { return place / sizeof(Ray); }
HWY_INLINE const Ray& row_at(const Ray* rows, std::uint32_t place) {
  return *reinterpret_cast<const Ray*>(reinterpret_cast<const char*>(rows) + place);
}
HWY_INLINE Ray& row_at(Ray* rows, std::uint32_t place) {
  return *reinterpret_cast<Ray*>(reinterpret_cast<char*>(rows) + place);
}

#if HWY_TARGET != HWY_SCALAR
template <class D, class Row>
HWY_INLINE hn::Vec<D> load_rows(D d, const Row& row, std::size_t i) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(d, row(i));
  } else {
    const hn::Half<D> fewer;
    return hn::Combine(d, load_rows(fewer, row, i + hn::MaxLanes(fewer)), load_rows(fewer, row, i));
  }
}
#endif

/// Loads rows of four floats at `row(0)`, `row(1)` ..., one for each lane, and transposes them.
/// Four lanes or more: the rows i, i + 4, i + 8 ... are loaded into one register.
template <class D, class Row>
HWY_INLINE void load_transposed(D d, const Row& row, Triple<D>& point, hn::Vec<D>& fourth) {
  if constexpr (hn::MaxLanes(D()) < 4) {
    constexpr std::size_t kCount = hn::MaxLanes(D());
    alignas(16) std::array<std::array<float, kCount>, 4> columns;
    for (std::size_t lane = 0; lane < kCount; ++lane) {
      for (std::size_t i = 0; i < 4; ++i) columns[i][lane] = row(lane)[i];
    }
    point = {hn::LoadU(d, columns[0].data()), hn::LoadU(d, columns[1].data()),
             hn::LoadU(d, columns[2].data())};
    fourth = hn::LoadU(d, columns[3].data());
  }
#if HWY_TARGET != HWY_SCALAR
  else {
    const hn::Repartition<double, D> pairs;
    const auto a = load_rows(d, row, 0);
    const auto b = load_rows(d, row, 1);
    const auto c = load_rows(d, row, 2);
    const auto e = load_rows(d, row, 3);
    const auto xy_0 = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
    const auto xy_1 = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
    const auto zw_0 = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
    const auto zw_1 = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
    point.x = hn::BitCast(d, hn::InterleaveLower(pairs, xy_0, xy_1));
    point.y = hn::BitCast(d, hn::InterleaveUpper(pairs, xy_0, xy_1));
    point.z = hn::BitCast(d, hn::InterleaveLower(pairs, zw_0, zw_1));
    fourth = hn::BitCast(d, hn::InterleaveUpper(pairs, zw_0, zw_1));
  }
#endif
}

/// Loads as many rays as there are lanes.
HWY_INLINE LaneRays<Tag> load_rays(const Ray* rows, const std::uint32_t* places) {
  LaneRays<Tag> rays;
  const auto origin = [&](std::size_t i) { return &row_at(rows, places[i]).origin.x; };
  const auto direction = [&](std::size_t i) { return &row_at(rows, places[i]).direction.x; };
  load_transposed(Tag(), origin, rays.origin, rays.t_min);
  load_transposed(Tag(), direction, rays.direction, rays.t_max);
  return rays;
}

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
