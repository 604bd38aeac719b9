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

#include "accel/bvh/probe_blocks-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

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
