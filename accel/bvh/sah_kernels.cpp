#include "accel/bvh/sah_kernels.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "accel/bvh/probe_ray.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/pick_target.hpp"
#include "accel/core/slab_ray.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/bvh/sah_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "accel/bvh/probe_blocks-inl.hpp"
#include "accel/core/compress-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using accel::HWY_NAMESPACE::compress;

/// Returns the children whose boxes the ray may meet before `limit`, which is enlarged by kWider,
/// and the t at which it enters them.
HWY_INLINE LaneBits meet_children(const WideNode& node, const ProbeRay& ray, float limit,
                                  float* enter_t) {
  const Tag tag;
  return test_registers([&](std::size_t lane) {
    const auto plane_t = [&](std::size_t row, std::size_t axis,
                             const std::array<float, 3>& inverse) {
      const Floats plane = hn::Load(tag, node.planes[row].data() + lane);
      return hn::Mul(hn::Sub(plane, hn::Set(tag, ray.origin[axis])), hn::Set(tag, inverse[axis]));
    };
    const auto near_t = [&](std::size_t axis) {
      return plane_t(ray.near_row[axis], axis, ray.inverse);
    };
    const auto far_t = [&](std::size_t axis) {
      return plane_t(ray.far_row[axis], axis, ray.far_inverse);
    };
    const Floats enter =
        hn::Max(hn::Max(near_t(0), near_t(1)), hn::Max(near_t(2), hn::Set(tag, ray.t_min)));
    const Floats exit =
        hn::Min(hn::Min(far_t(0), far_t(1)), hn::Min(far_t(2), hn::Set(tag, limit)));
    hn::Store(enter, tag, enter_t + lane);
    return hn::Le(enter, exit);
  });
}

/// The stack of pending entries, the next on top, each with the t at which the ray enters it.
class WaitingStack {
 public:
  /// Pops the next entry that is entered before `limit`; returns false if there is none.
  HWY_INLINE bool pop(float limit, ChildReference& next) {
    while (size_ > 0) {
      --size_;
      if (enter_t_[size_] <= limit) {
        next = ChildReference::from_bits(references_[size_]);
        return true;
      }
    }
    return false;
  }

  /// Pushes all children except the nearest, which it returns. Two children are compared by entry
  /// distance, more than two along the octant's diagonal.
  HWY_INLINE ChildReference push_but_nearest(const WideNode& node, LaneBits met, std::size_t octant,
                                             const float* enter_t) {
    const LaneBits rest = met & (met - 1);
    const auto first = static_cast<std::size_t>(std::countr_zero(met));
    if (rest == 0) return node.children[first];
    if ((rest & (rest - 1)) == 0) {
      const auto second = static_cast<std::size_t>(std::countr_zero(rest));
      const bool in_order = enter_t[first] <= enter_t[second];
      const std::size_t farther = in_order ? second : first;
      enter_t_[size_] = enter_t[farther];
      references_[size_++] = node.children[farther].bits();
      return node.children[in_order ? first : second];
    }
    push(node, met, octant, enter_t);
    return ChildReference::from_bits(references_[--size_]);
  }

  /// Pops the next entry; returns false if there is none.
  HWY_INLINE bool pop_any(ChildReference& next) {
    if (size_ == 0) return false;
    next = ChildReference::from_bits(references_[--size_]);
    return true;
  }

  /// Pushes all children except the last, which it returns. Must not be used with `pop`.
  HWY_INLINE ChildReference push_but_last(const WideNode& node, LaneBits met) {
    const auto last = static_cast<std::size_t>(std::bit_width(met) - 1);
    const LaneBits rest = met ^ LaneBits { 1 } << last;
    const Tag tag;
    const hn::RebindToUnsigned<Tag> bits;
    if (rest != 0) {
      if constexpr (hn::MaxLanes(tag) == kBvhLanes) {
        const auto* references = reinterpret_cast<const std::uint32_t*>(node.children.data());
        const std::array<std::uint8_t, 8> lanes{static_cast<std::uint8_t>(rest)};
        const auto mask = hn::LoadMaskBits(bits, lanes.data());
        hn::StoreU(compress(bits, hn::LoadU(bits, references), mask), bits,
                   references_.data() + size_);
        size_ += static_cast<std::size_t>(std::popcount(rest));
      } else {
        for (std::size_t lane = 0; lane < kBvhLanes; ++lane) {
          references_[size_] = node.children[lane].bits();
          size_ += rest >> lane & 1U;
        }
      }
    }
    return node.children[last];
  }

 private:
  /// Pushes the children of `met`, the farthest first.
  HWY_INLINE void push(const WideNode& node, LaneBits met, std::size_t octant,
                       const float* enter_t) {
    const Tag tag;
    const hn::RebindToUnsigned<Tag> bits;
    const std::uint32_t order = node.orders[octant];
    if constexpr (hn::MaxLanes(tag) == kBvhLanes) {
      const auto lanes =
          hn::And(hn::Shr(hn::Set(bits, order), hn::Mul(hn::Iota(bits, 0), hn::Set(bits, 3))),
                  hn::Set(bits, 7));
      const auto wanted = hn::And(hn::Shr(hn::Set(bits, met), lanes), hn::Set(bits, 1));
      const auto table =
          hn::IndicesFromVec(bits, compress(bits, lanes, hn::Ne(wanted, hn::Zero(bits))));
      const auto* enter = reinterpret_cast<const std::uint32_t*>(enter_t);
      const auto* references = reinterpret_cast<const std::uint32_t*>(node.children.data());
      hn::StoreU(hn::TableLookupLanes(hn::LoadU(bits, enter), table), bits,
                 reinterpret_cast<std::uint32_t*>(enter_t_.data() + size_));
      hn::StoreU(hn::TableLookupLanes(hn::LoadU(bits, references), table), bits,
                 references_.data() + size_);
      size_ += static_cast<std::size_t>(std::popcount(met));
    } else {
      for (std::size_t i = 0; i < kBvhLanes; ++i) {
        const std::size_t lane = order >> 3 * i & 7U;
        enter_t_[size_] = enter_t[lane];
        references_[size_] = node.children[lane].bits();
        size_ += met >> lane & 1U;
      }
    }
  }

  /// Each node on the longest path leaves at most seven children pending, and a whole register is
  /// stored above them.
  static constexpr std::size_t kRoom = kMaxBvhDepth * (kBvhLanes - 1) + 1 + kBvhLanes;

  std::size_t size_ = 0;
  std::array<float, kRoom> enter_t_;
  std::array<std::uint32_t, kRoom> references_;  // bits: ChildReferences would be initialized
};

inline scenes::Bounds bounds_of(const WideNode& node) {
  scenes::Bounds bounds;
  for (std::size_t lane = 0; lane < node.count(); ++lane) {
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

/// Describes a step of the traversal path.
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
    counting.add(Counter::kBoxTests, bvh.nodes[at.node_index()].count());
  }
}

/// Traverses the hierarchy, nearest child first for a closest hit, and returns the result of
/// `Confirm`. Everything is inlined: otherwise GCC calls a function for each node and keeps the ray
/// in memory, which takes 10% longer.
template <bool kAny, class Confirm, class Counting>
HWY_FLATTEN auto traverse(const WideBvh& bvh, const scenes::Scene& scene, const Ray& ray,
                          Counting& counting) {
  const ProbeRay probe_ray(ray, bvh.scene_bounds);
  Confirm confirm(scene, ray);
  WaitingStack waiting;
  ChildReference at = bvh.root;
  while (true) {
    count_step(counting, bvh, scene, ray, at);
    if (at.is_leaf()) {
      const std::span blocks(bvh.blocks.data() + at.first_block(), at.block_count());
      if (test_blocks(blocks, probe_ray, counting, confirm)) break;
    } else {
      const WideNode& node = bvh.nodes[at.node_index()];
      alignas(64) std::array<float, kBvhLanes> enter_t;
      const float limit = confirm.t_max * ProbeRay::kWider;
      const LaneBits met = meet_children(node, probe_ray, limit, enter_t.data());
      if (met != 0) {
        if constexpr (kAny) {
          at = waiting.push_but_last(node, met);
        } else {
          at = waiting.push_but_nearest(node, met, probe_ray.octant, enter_t.data());
        }
        continue;
      }
    }
    const float limit = confirm.t_max * ProbeRay::kWider;
    if (!(kAny ? waiting.pop_any(at) : waiting.pop(limit, at))) break;
  }
  return confirm.result();
}

template <class Counting>
std::optional<Hit> closest(const WideBvh& bvh, const scenes::Scene& scene, const Ray& ray,
                           Counting& counting) {
  return traverse<false, ConfirmClosest>(bvh, scene, ray, counting);
}

template <class Counting>
bool any(const WideBvh& bvh, const scenes::Scene& scene, const Ray& ray, Counting& counting) {
  return traverse<true, ConfirmAny>(bvh, scene, ray, counting);
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

const SahKernels& sah_kernels_for(std::int64_t targets) {
  return pick_target(HWY_DISPATCH_TABLE(kernels), targets)();
}

}  // namespace beambench::accel::bvh
#endif
