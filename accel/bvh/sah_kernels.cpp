#include "accel/bvh/sah_kernels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "accel/bvh/probe_ray.hpp"
#include "accel/bvh/slab_ray.hpp"
#include "accel/core/intersect.hpp"

// Highway includes this file once more for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/bvh/sah_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Eight lanes where the registers have them, otherwise several registers of fewer.
using Tag = hn::CappedTag<float, kBvhLanes>;
using Floats = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

/// One bit per lane.
using LaneBits = std::uint32_t;

/// Calls `test(lane)` for the first lane of each register and joins the masks it returns.
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

/// The children whose boxes the ray may meet before `limit`, and where it enters them.
inline LaneBits meet_children(const WideNode& node, const ProbeRay& ray, float limit,
                              float* enter_t) {
  const Tag tag;
  return test_registers([&](std::size_t lane) {
    const auto plane_t = [&](std::size_t row, std::size_t axis) {
      const Floats plane = hn::Load(tag, node.planes[row].data() + lane);
      return hn::Mul(hn::Sub(plane, hn::Set(tag, ray.origin[axis])),
                     hn::Set(tag, ray.inverse[axis]));
    };
    const Floats enter = hn::Max(hn::Max(plane_t(ray.near_row[0], 0), plane_t(ray.near_row[1], 1)),
                                 hn::Max(plane_t(ray.near_row[2], 2), hn::Set(tag, ray.t_min)));
    const Floats exit = hn::Min(hn::Min(plane_t(ray.far_row[0], 0), plane_t(ray.far_row[1], 1)),
                                hn::Min(plane_t(ray.far_row[2], 2), hn::Set(tag, limit)));
    hn::Store(enter, tag, enter_t + lane);
    return hn::Le(enter, hn::Mul(exit, hn::Set(tag, ProbeRay::kWider)));
  });
}

/// The triangles that the ray may hit in [t_min, t_max].
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
    return hn::And(surrounds, in_time);
  });
}

/// The spheres that the ray may hit in [t_min, t_max].
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
    const Floats t = hn::Mul(along, hn::Set(tag, per_square));  // of the point nearest the center
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

/// The canonical test of one lane.
inline float confirm(const CanonicalRay& ray, const scenes::Scene& scene,
                     const PrimitiveBlock& block, std::size_t lane) {
  if (block.kind == scenes::PrimitiveKind::kPolygon) {
    return intersect_triangle(ray, block.corner(0, lane), block.corner(1, lane),
                              block.corner(2, lane));
  }
  return intersect(ray, scene, block.primitives[lane]);
}

/// The entries still to be visited: the float bits of where the ray enters them, which order as the
/// floats do, above the reference. The nearest is on top.
class WaitingStack {
 public:
  bool empty() const { return size_ == 0; }
  void push(float enter_t, ChildReference child) {
    entries_[size_++] = std::uint64_t{std::bit_cast<std::uint32_t>(enter_t)} << 32U | child.bits();
  }
  /// Puts the nearest of the last `count` entries on top, the farthest below.
  void sort_last(std::size_t count) {
    std::uint64_t* first = entries_.data() + (size_ - count);
    for (std::size_t i = 1; i < count; ++i) {
      const std::uint64_t moving = first[i];
      std::size_t hole = i;
      for (; hole > 0 && first[hole - 1] < moving; --hole) first[hole] = first[hole - 1];
      first[hole] = moving;
    }
  }
  ChildReference pop(float& enter_t) {
    const std::uint64_t entry = entries_[--size_];
    enter_t = std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32U));
    return ChildReference::from_bits(static_cast<std::uint32_t>(entry));
  }

 private:
  std::array<std::uint64_t, kMaxBvhDepth*(kBvhLanes - 1) + 1> entries_;  // the maximum depth
  std::size_t size_ = 0;
};

inline scenes::Bounds bounds_of(const WideNode& node) {
  scenes::Bounds bounds;
  for (std::size_t lane = 0; lane < node.count; ++lane) {
    const auto& plane = node.planes;
    bounds.include(glm::vec3(plane[0][lane], plane[1][lane], plane[2][lane]));
    bounds.include(glm::vec3(plane[3][lane], plane[4][lane], plane[5][lane]));
  }
  return bounds;
}

inline scenes::Bounds bounds_of(const PrimitiveBlock& block, const scenes::Scene& scene) {
  scenes::Bounds bounds;
  for (std::size_t lane = 0; lane < block.count; ++lane) {
    if (block.kind == scenes::PrimitiveKind::kPolygon) {
      for (std::size_t i = 0; i < 3; ++i) bounds.include(block.corner(i, lane));
    } else {
      bounds.include(scenes::primitive_bounds(scene, block.primitives[lane]));
    }
  }
  return bounds;
}

/// A step of the traversal path.
inline TraceStep describe(const WideBvh& bvh, const scenes::Scene& scene, const Ray& ray,
                          ChildReference at) {
  TraceStep step{.place = at.is_leaf() ? "leaf" : "node"};
  scenes::Bounds bounds;
  if (at.is_leaf()) {
    step.index = at.first_block();
    for (std::uint32_t i = 0; i < at.block_count(); ++i) {
      bounds.include(bounds_of(bvh.blocks[at.first_block() + i], scene));
    }
  } else {
    step.index = at.node_index();
    bounds = bounds_of(bvh.nodes[at.node_index()]);
  }
  step.box = Box{glm::dvec3(bounds.lower), glm::dvec3(bounds.upper)};
  const BoxInterval inside = SlabRay(ray).interval(bounds, ray.t_min, ray.t_max);
  step.t_enter = inside.enter;
  step.t_exit = inside.exit;
  return step;
}

template <class Counting>
void count_step(Counting& counting, const WideBvh& bvh, const scenes::Scene& scene, const Ray& ray,
                ChildReference at) {
  counting.add(Counter::kTraversalSteps);
  counting.enter([&] { return describe(bvh, scene, ray, at); });
  if (at.is_leaf()) {
    counting.add(Counter::kLeaves);
  } else {
    counting.add(Counter::kBoxTests, bvh.nodes[at.node_index()].count);
  }
}

/// Records what the probe rejected as tested and missed.
template <class Counting>
void count_probes(Counting& counting, const PrimitiveBlock& block, LaneBits passed) {
  counting.add(Counter::kPrimitiveTests, block.count);
  counting.add("confirmed_tests", static_cast<std::uint64_t>(std::popcount(passed)));
  for (std::size_t lane = 0; lane < block.count; ++lane) {
    if ((passed >> lane & 1U) == 0) counting.tested(block.primitives[lane], kMiss);
  }
}

/// Traverses the hierarchy, nearest child first. Everything is inlined: otherwise GCC calls the
/// lambdas for each node, with the ray in memory, which costs a tenth of the time. `visit(t,
/// primitive)` gets the result of each canonical test and returns true to end the traversal; hits
/// beyond `t_max()` do not matter.
template <class Counting, class FarEnd, class Visit>
HWY_FLATTEN void walk(const WideBvh& bvh, const scenes::Scene& scene, const Ray& ray,
                      const CanonicalRay& canonical, Counting& counting, FarEnd t_max,
                      Visit visit) {
  const ProbeRay probe_ray(ray, bvh.scene_bounds);
  WaitingStack waiting;
  ChildReference at = bvh.root;
  float at_t = ray.t_min;
  while (true) {
    count_step(counting, bvh, scene, ray, at);
    if (at.is_leaf()) {
      const PrimitiveBlock* block = bvh.blocks.data() + at.first_block();
      for (const PrimitiveBlock* end = block + at.block_count(); block != end; ++block) {
        LaneBits lanes = probe(*block, probe_ray, t_max());
        count_probes(counting, *block, lanes);
        for (; lanes != 0; lanes &= lanes - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
          const float t = confirm(canonical, scene, *block, lane);
          counting.tested(block->primitives[lane], t);
          if (visit(t, block->primitives[lane])) return;
        }
      }
    } else {
      const WideNode& node = bvh.nodes[at.node_index()];
      alignas(64) std::array<float, kBvhLanes> enter_t;
      LaneBits met = meet_children(node, probe_ray, t_max(), enter_t.data());
      if (met != 0) {
        const auto nearest = static_cast<std::size_t>(std::countr_zero(met));
        at = node.children[nearest];
        at_t = enter_t[nearest];
        met &= met - 1;
        if (met == 0) continue;
        std::size_t count = 1;
        waiting.push(at_t, at);
        for (; met != 0; met &= met - 1, ++count) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(met));
          waiting.push(enter_t[lane], node.children[lane]);
        }
        waiting.sort_last(count);
        at = waiting.pop(at_t);
        continue;
      }
    }
    do {
      if (waiting.empty()) return;
      at = waiting.pop(at_t);
    } while (at_t > t_max() * ProbeRay::kWider);
  }
}

template <class Counting>
std::optional<Hit> closest(const WideBvh& bvh, const scenes::Scene& scene, const Ray& ray,
                           Counting& counting) {
  ClosestHit best(ray);
  walk(
      bvh, scene, ray, best.ray, counting, [&] { return best.ray.t_max; },
      [&](float t, scenes::PrimitiveId primitive) {
        best.keep(t, primitive);
        return false;
      });
  return best.result();
}

template <class Counting>
bool any(const WideBvh& bvh, const scenes::Scene& scene, const Ray& ray, Counting& counting) {
  const CanonicalRay canonical(ray);
  bool found = false;
  walk(
      bvh, scene, ray, canonical, counting, [&] { return ray.t_max; },
      [&](float t, scenes::PrimitiveId) {
        found = is_hit(t);
        return found;
      });
  return found;
}

template <class Counting>
constexpr SahQueries<Counting> queries() {
  return {closest<Counting>, any<Counting>};
}

const SahKernels& kernels() {
  static constexpr SahKernels kKernels{queries<NoCounting>(), queries<WorkCounters>(),
                                       queries<StepRecorder>(), HWY_TARGET};
  return kKernels;
}

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::accel::bvh {

HWY_EXPORT(kernels);

const SahKernels& best_sah_kernels() { return HWY_DYNAMIC_DISPATCH(kernels)(); }

}  // namespace beambench::accel::bvh
#endif
