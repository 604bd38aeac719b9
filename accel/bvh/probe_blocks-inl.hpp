// The float tests of a ray against a block of primitives, compiled for each instruction set. They
// can reject primitives but cannot confirm hits.

#if defined(ACCEL_BVH_PROBE_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_BVH_PROBE_BLOCKS_INL
#undef ACCEL_BVH_PROBE_BLOCKS_INL
#else
#define ACCEL_BVH_PROBE_BLOCKS_INL
#endif

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <hwy/highway.h>

#include "accel/bvh/primitive_block.hpp"
#include "accel/bvh/probe_ray.hpp"
#include "accel/core/intersect.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Eight lanes if a register has that many; otherwise several registers with fewer.
using Tag = hn::CappedTag<float, kBvhLanes>;
using Floats = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

/// One bit per lane.
using LaneBits = std::uint32_t;

/// Calls `test(lane)` for the first lane of each register and combines the masks it returns.
template <class Test>
LaneBits test_registers(Test test) {
  const Tag tag;
  LaneBits bits = 0;
  for (std::size_t lane = 0; lane < kBvhLanes; lane += hn::Lanes(tag)) {
    std::array<std::uint8_t, 8> stored{};
    hn::StoreMaskBits(tag, test(lane), stored.data());
    bits |= static_cast<LaneBits>(stored[0]) << lane;
  }
  return bits;
}

/// Returns the triangles that the ray may hit in [t_min, t_max].
inline LaneBits probe_triangles(const PrimitiveBlock& block, const ProbeRay& ray, float t_max) {
  const Tag tag;
  const std::size_t x = ray.side_axis[0];
  const std::size_t y = ray.side_axis[1];
  const std::size_t z = ray.main_axis;
  const Floats shear_x = hn::Set(tag, ray.shear[0]);
  const Floats shear_y = hn::Set(tag, ray.shear[1]);
  const float margin = ray.area_margin(block.leaf_extent);

  struct Corner {
    Floats x, y, z;
  };
  return test_registers([&](std::size_t lane) {
    const auto corner = [&](std::size_t which) -> Corner {
      const auto from_origin = [&](std::size_t axis) {
        return hn::Sub(hn::Load(tag, block.coordinates[3 * which + axis].data() + lane),
                       hn::Set(tag, ray.origin[axis]));
      };
      const Floats along = from_origin(z);
      return {hn::NegMulAdd(shear_x, along, from_origin(x)),
              hn::NegMulAdd(shear_y, along, from_origin(y)), along};
    };
    const Corner a = corner(0);
    const Corner b = corner(1);
    const Corner c = corner(2);
    const Floats u = hn::MulSub(c.x, b.y, hn::Mul(c.y, b.x));
    const Floats v = hn::MulSub(a.x, c.y, hn::Mul(a.y, c.x));
    const Floats w = hn::MulSub(b.x, a.y, hn::Mul(b.y, a.x));
    const Mask surrounds = hn::Or(hn::Ge(hn::Min(hn::Min(u, v), w), hn::Set(tag, -margin)),
                                  hn::Le(hn::Max(hn::Max(u, v), w), hn::Set(tag, margin)));

    const Floats per_t = hn::Set(tag, ray.inverse[z]);
    const Floats ta = hn::Mul(a.z, per_t);
    const Floats tb = hn::Mul(b.z, per_t);
    const Floats tc = hn::Mul(c.z, per_t);
    const Mask in_time =
        hn::And(hn::Le(hn::Min(hn::Min(ta, tb), tc),
                       hn::Set(tag, t_max * ProbeRay::kWider + ray.depth_margin)),
                hn::Ge(hn::Mul(hn::Max(hn::Max(ta, tb), tc), hn::Set(tag, ProbeRay::kWider)),
                       hn::Set(tag, ray.t_min - ray.depth_margin)));
    const Mask near_it = hn::And(surrounds, in_time);
    if (hn::AllFalse(tag, near_it)) return near_it;

    // Most rays begin on a triangle, which passes the tests above. If the ray certainly meets its
    // plane behind the origin, it need not be confirmed (probe_ray.hpp).
    struct Vector {
      Floats x, y, z;
    };
    const auto difference = [&](std::size_t to, const auto& from) -> Vector {
      const auto along = [&](std::size_t axis) {
        return hn::Sub(hn::Load(tag, block.coordinates[3 * to + axis].data() + lane), from(axis));
      };
      return {along(0), along(1), along(2)};
    };
    const auto first_corner = [&](std::size_t axis) {
      return hn::Load(tag, block.coordinates[axis].data() + lane);
    };
    const auto size = [](const Vector& vector) {
      return hn::Add(hn::Add(hn::Abs(vector.x), hn::Abs(vector.y)), hn::Abs(vector.z));
    };
    const Vector e = difference(1, first_corner);
    const Vector f = difference(2, first_corner);
    const Vector to_a =
        difference(0, [&](std::size_t axis) { return hn::Set(tag, ray.origin[axis]); });
    const Floats volume =
        hn::MulAdd(to_a.x, hn::MulSub(e.y, f.z, hn::Mul(e.z, f.y)),
                   hn::MulAdd(to_a.y, hn::MulSub(e.z, f.x, hn::Mul(e.x, f.z)),
                              hn::Mul(to_a.z, hn::MulSub(e.x, f.y, hn::Mul(e.y, f.x)))));
    const Floats error = hn::MulAdd(
        hn::Mul(size(e), size(f)),
        hn::MulAdd(size(to_a), hn::Set(tag, 0x1p-20F), hn::Set(tag, 0x1p-9F * ray.rounding)),
        hn::Set(tag, 0x1p-120F));  // products that underflow or are flushed to zero
    const Floats total = hn::Add(hn::Add(u, v), w);
    const Floats side = hn::Mul(hn::Mul(total, per_t), volume);  // has the sign of -t
    const Mask sure = hn::And(hn::Gt(hn::Abs(total), hn::Set(tag, 4.0F * margin)),
                              hn::Gt(hn::Abs(volume), error));
    const Mask behind = hn::And(sure, hn::Gt(side, hn::Zero(tag)));
    return hn::AndNot(behind, near_it);
  });
}

/// Returns the spheres that the ray may hit in [t_min, t_max].
inline LaneBits probe_spheres(const PrimitiveBlock& block, const ProbeRay& ray, float t_max) {
  const Tag tag;
  const float per_square =
      1.0F / (ray.direction[0] * ray.direction[0] + ray.direction[1] * ray.direction[1] +
              ray.direction[2] * ray.direction[2]);
  const float per_length = std::sqrt(per_square);
  const Floats margin = hn::Set(tag, 32.0F * ray.rounding);
  return test_registers([&](std::size_t lane) {
    const auto row = [&](std::size_t index) {
      return hn::Load(tag, block.coordinates[index].data() + lane);
    };
    const auto direction = [&](std::size_t axis) { return hn::Set(tag, ray.direction[axis]); };
    const Floats x = hn::Sub(row(0), hn::Set(tag, ray.origin[0]));
    const Floats y = hn::Sub(row(1), hn::Set(tag, ray.origin[1]));
    const Floats z = hn::Sub(row(2), hn::Set(tag, ray.origin[2]));
    const Floats along =
        hn::MulAdd(x, direction(0), hn::MulAdd(y, direction(1), hn::Mul(z, direction(2))));
    const Floats t = hn::Mul(along, hn::Set(tag, per_square));  // at the point nearest the center
    const Floats beside_x = hn::NegMulAdd(t, direction(0), x);
    const Floats beside_y = hn::NegMulAdd(t, direction(1), y);
    const Floats beside_z = hn::NegMulAdd(t, direction(2), z);
    const Floats square =
        hn::MulAdd(beside_x, beside_x, hn::MulAdd(beside_y, beside_y, hn::Mul(beside_z, beside_z)));
    const Floats radius = hn::Mul(hn::Add(row(3), margin), hn::Set(tag, ProbeRay::kWider));
    const Floats half_chord = hn::Mul(radius, hn::Set(tag, per_length * ProbeRay::kWider));
    const Floats slack = hn::Mul(margin, hn::Set(tag, per_length));
    const Mask in_time = hn::And(
        hn::Le(hn::Sub(hn::Sub(t, half_chord), slack), hn::Set(tag, t_max * ProbeRay::kWider)),
        hn::Ge(hn::Mul(hn::Add(hn::Add(t, half_chord), slack), hn::Set(tag, ProbeRay::kWider)),
               hn::Set(tag, ray.t_min)));
    return hn::And(hn::Le(square, hn::Mul(radius, radius)), in_time);
  });
}

inline LaneBits probe(const PrimitiveBlock& block, const ProbeRay& ray, float t_max) {
  const LaneBits present = (LaneBits{1} << block.count) - 1;
  switch (block.kind) {
    case scenes::PrimitiveKind::kPolygon:
      return present & probe_triangles(block, ray, t_max);
    case scenes::PrimitiveKind::kSphere:
      return present & probe_spheres(block, ray, t_max);
    case scenes::PrimitiveKind::kCone:
      break;
  }
  return present;
}

/// Runs the canonical test of the primitive in one lane.
inline float confirm(const CanonicalRay& ray, const scenes::Scene& scene,
                     const PrimitiveBlock& block, std::size_t lane) {
  if (block.kind == scenes::PrimitiveKind::kPolygon) {
    return intersect_triangle(ray, block.corner(0, lane), block.corner(1, lane),
                              block.corner(2, lane));
  }
  return intersect(ray, scene, block.primitives[lane]);
}

/// Counts the primitives that the probe rejected as tested and missed.
template <class Counting>
void count_probes(Counting& counting, const PrimitiveBlock& block, LaneBits passed) {
  counting.add_tests(block.kind, block.count);
  counting.add("confirmed_tests", static_cast<std::uint64_t>(std::popcount(passed)));
  for (std::size_t lane = 0; lane < block.count; ++lane) {
    if ((passed >> lane & 1U) == 0) counting.tested(block.primitives[lane], kMiss);
  }
}

/// Tests the blocks of a leaf. `confirm(counting, block, lane)` runs the canonical test of possible
/// hits before `confirm.t_max`, may lower that, and returns true to stop; this function then
/// returns true as well.
template <class Counting, class Confirm>
HWY_INLINE bool test_blocks(std::span<const PrimitiveBlock> blocks, const ProbeRay& ray,
                            Counting& counting, Confirm& confirm) {
  for (const PrimitiveBlock& block : blocks) {
    LaneBits lanes = probe(block, ray, confirm.t_max);
    count_probes(counting, block, lanes);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      if (confirm(counting, block, lane)) return true;
    }
  }
  return false;
}

// Many rays need no canonical test, so the canonical ray is created only before the first one.

/// Keeps the closest confirmed hit; `t_max` is its t.
class ConfirmClosest {
 public:
  ConfirmClosest(const scenes::Scene& scene, const Ray& ray)
      : t_max(ray.t_max), scene_(&scene), ray_(&ray) {}

  template <class Counting>
  bool operator()(Counting& counting, const PrimitiveBlock& block, std::size_t lane) {
    if (!best_) best_.emplace(*ray_);
    const float t = confirm(best_->ray, *scene_, block, lane);
    counting.tested(block.primitives[lane], t);
    best_->keep(t, block.primitives[lane]);
    t_max = best_->ray.t_max;
    return false;
  }
  std::optional<Hit> result() const { return best_ ? best_->result() : std::nullopt; }

  float t_max;

 private:
  const scenes::Scene* scene_;
  const Ray* ray_;
  std::optional<ClosestHit> best_;
};

/// Stops at the first hit.
class ConfirmAny {
 public:
  ConfirmAny(const scenes::Scene& scene, const Ray& ray)
      : t_max(ray.t_max), scene_(&scene), ray_(&ray) {}

  template <class Counting>
  bool operator()(Counting& counting, const PrimitiveBlock& block, std::size_t lane) {
    if (!canonical_) canonical_.emplace(*ray_);
    const float t = confirm(*canonical_, *scene_, block, lane);
    counting.tested(block.primitives[lane], t);
    found_ = is_hit(t);
    return found_;
  }
  bool result() const { return found_; }

  const float t_max;

 private:
  const scenes::Scene* scene_;
  const Ray* ray_;
  std::optional<CanonicalRay> canonical_;
  bool found_ = false;
};

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
