// Single rays through the hierarchy: float tests that only reject, then the canonical ones.

#if defined(ACCEL_TILE_BEAM_RAY_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_RAY_WALK_INL
#undef ACCEL_TILE_BEAM_RAY_WALK_INL
#else
#define ACCEL_TILE_BEAM_RAY_WALK_INL
#endif

#include <bit>
#include <optional>

#include "accel/bvh/probe_ray.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// The boxes that a ray may meet before `limit`, and where it enters them (see ProbeRay).
HWY_INLINE LaneBits meet_boxes(const TileNode& node, const bvh::ProbeRay& ray, float limit,
                               float* enter_t) {
  const LaneBits met = for_each_register([&](std::size_t lane) {
    const auto plane_t = [&](std::size_t row, std::size_t axis) {
      return hn::Mul(hn::Sub(load(&node.boxes.planes[row][lane]), all(ray.origin[axis])),
                     all(ray.inverse[axis]));
    };
    const Floats enter = hn::Max(hn::Max(plane_t(ray.near_row[0], 0), plane_t(ray.near_row[1], 1)),
                                 hn::Max(plane_t(ray.near_row[2], 2), all(ray.t_min)));
    const Floats exit = hn::Min(hn::Min(plane_t(ray.far_row[0], 0), plane_t(ray.far_row[1], 1)),
                                hn::Min(plane_t(ray.far_row[2], 2), all(limit)));
    store(enter, enter_t + lane);
    return hn::Le(enter, hn::Mul(exit, all(bvh::ProbeRay::kWider)));
  });
  return met & ((LaneBits{1} << node.count) - 1);
}

/// The triangles of a meshlet, from `first` on, that a ray may hit in [t_min, t_max].
class MeshletProbe {
 public:
  HWY_INLINE MeshletProbe(const Meshlet& meshlet, const bvh::ProbeRay& ray)
      : meshlet_(&meshlet), ray_(&ray) {
    const std::size_t x = ray.side_axis[0];
    const std::size_t y = ray.side_axis[1];
    const std::size_t z = ray.main_axis;
    for (std::size_t i = 0; i < meshlet.vertex_count; i += kLanes) {
      const Floats along = hn::Sub(load(&meshlet.vertices[z][i]), all(ray.origin[z]));
      const auto sheared = [&](std::size_t axis, float shear) {
        return hn::NegMulAdd(all(shear), along,
                             hn::Sub(load(&meshlet.vertices[axis][i]), all(ray.origin[axis])));
      };
      store(sheared(x, ray.shear[0]), &x_[i]);
      store(sheared(y, ray.shear[1]), &y_[i]);
      store(hn::Mul(along, all(ray.inverse[z])), &t_[i]);
    }
  }

  HWY_INLINE LaneBits may_hit(std::size_t first, float t_max) const {
    const hn::Rebind<std::uint8_t, Tag> bytes;
    struct Corner {
      Floats x, y, t;
    };
    const auto corner = [&](std::size_t which) -> Corner {
      const Ints index =
          hn::PromoteTo(IntTag(), hn::LoadU(bytes, meshlet_->corners[which].data() + first));
      return {Table32(x_.data()).at(index), Table32(y_.data()).at(index),
              Table32(t_.data()).at(index)};
    };
    const Corner a = corner(0);
    const Corner b = corner(1);
    const Corner c = corner(2);
    const Floats u = hn::MulSub(c.x, b.y, hn::Mul(c.y, b.x));
    const Floats v = hn::MulSub(a.x, c.y, hn::Mul(a.y, c.x));
    const Floats w = hn::MulSub(b.x, a.y, hn::Mul(b.y, a.x));
    const float margin = ray_->area_margin(meshlet_->extent);
    const Mask surrounds = hn::Or(hn::Ge(hn::Min(hn::Min(u, v), w), all(-margin)),
                                  hn::Le(hn::Max(hn::Max(u, v), w), all(margin)));
    const Mask in_time =
        hn::And(hn::Le(hn::Min(hn::Min(a.t, b.t), c.t),
                       all(t_max * bvh::ProbeRay::kWider + ray_->depth_margin)),
                hn::Ge(hn::Mul(hn::Max(hn::Max(a.t, b.t), c.t), all(bvh::ProbeRay::kWider)),
                       all(ray_->t_min - ray_->depth_margin)));
    const Mask present = hn::FirstN(Tag(), meshlet_->triangle_count - first);
    return bits_of(hn::And(present, hn::And(surrounds, in_time)));
  }

 private:
  const Meshlet* meshlet_;
  const bvh::ProbeRay* ray_;
  alignas(64) std::array<float, Meshlet::kMaxVertices> x_;
  alignas(64) std::array<float, Meshlet::kMaxVertices> y_;
  alignas(64) std::array<float, Meshlet::kMaxVertices> t_;
};

/// The entries still to be visited: the bits of where the ray enters them, which order as the
/// floats do, above the child's. The nearest is on top.
class WaitingChildren {
 public:
  bool empty() const { return size_ == 0; }
  void push(float enter_t, TileChild child) {
    const std::uint64_t entry =
        std::uint64_t{std::bit_cast<std::uint32_t>(enter_t)} << 32U | child.bits();
    std::size_t hole = size_++;
    for (; hole > sorted_from_ && entries_[hole - 1] < entry; --hole) {
      entries_[hole] = entries_[hole - 1];
    }
    entries_[hole] = entry;
  }
  /// Those pushed from here on are sorted among themselves.
  void begin_siblings() { sorted_from_ = size_; }
  TileChild pop(float& enter_t) {
    const std::uint64_t entry = entries_[--size_];
    enter_t = std::bit_cast<float>(static_cast<std::uint32_t>(entry >> 32U));
    return TileChild::from_bits(static_cast<std::uint32_t>(entry));
  }

 private:
  std::array<std::uint64_t, kMaxTileDepth*(kTileLanes - 1) + 1> entries_;  // the maximum depth
  std::size_t size_ = 0;
  std::size_t sorted_from_ = 0;
};

/// Tests a leaf's primitives. `visit(t, primitive)` gets the result of each canonical test
/// and returns true to end; hits beyond `t_max()` do not matter. Returns whether it was ended.
template <class Counting, class FarEnd, class Visit>
HWY_INLINE bool visit_leaf(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                           TileChild leaf, const bvh::ProbeRay& probe, const CanonicalRay& ray,
                           Counting& counting, FarEnd t_max, Visit visit) {
  const auto confirm = [&](scenes::PrimitiveId primitive, float t) {
    counting.add_tests(scene.primitives[primitive].kind);
    counting.tested(primitive, t);
    return visit(t, primitive);
  };
  if (leaf.kind() == TileChild::Kind::kMeshlet) {
    const Meshlet& meshlet = hierarchy.meshlets[leaf.index()];
    const MeshletProbe triangles(meshlet, probe);
    for (std::size_t first = 0; first < meshlet.triangle_count; first += kLanes) {
      for (LaneBits left = triangles.may_hit(first, t_max()); left != 0; left &= left - 1) {
        const std::size_t triangle = first + static_cast<std::size_t>(std::countr_zero(left));
        const float t =
            intersect_triangle(ray, meshlet.corner(0, triangle), meshlet.corner(1, triangle),
                               meshlet.corner(2, triangle));
        if (confirm(meshlet.primitives[triangle], t)) return true;
      }
    }
    return false;
  }
  const auto test_each = [&](const auto& block) {
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      const scenes::PrimitiveId primitive = block.primitives[lane];
      if (confirm(primitive, intersect(ray, scene, primitive))) return true;
    }
    return false;
  };
  return leaf.kind() == TileChild::Kind::kSpheres ? test_each(hierarchy.spheres[leaf.index()])
                                                  : test_each(hierarchy.cones[leaf.index()]);
}

/// Traverses the hierarchy below `from`, nearest child first.
template <class Counting, class FarEnd, class Visit>
void walk_ray(const TileHierarchy& hierarchy, const scenes::Scene& scene, TileChild from,
              const Ray& ray, const CanonicalRay& canonical, Counting& counting, FarEnd t_max,
              Visit visit) {
  const bvh::ProbeRay probe(ray, hierarchy.bounds);
  WaitingChildren waiting;
  waiting.push(ray.t_min, from);
  while (!waiting.empty()) {
    float enter = 0.0F;
    const TileChild at = waiting.pop(enter);
    if (enter > t_max() * bvh::ProbeRay::kWider) continue;
    counting.add(Counter::kTraversalSteps);
    counting.enter([&] {
      return TraceStep{.place = at.kind() == TileChild::Kind::kNode ? "node" : "leaf",
                       .index = at.index(),
                       .t_enter = enter,
                       .t_exit = t_max()};
    });
    if (at.kind() != TileChild::Kind::kNode) {
      counting.add(Counter::kLeaves);
      if (visit_leaf(hierarchy, scene, at, probe, canonical, counting, t_max, visit)) return;
      continue;
    }
    const TileNode& node = hierarchy.nodes[at.index()];
    counting.add(Counter::kBoxTests, node.count);
    alignas(64) std::array<float, kTileLanes> enter_t;
    waiting.begin_siblings();
    for (LaneBits met = meet_boxes(node, probe, t_max(), enter_t.data()); met != 0;
         met &= met - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(met));
      waiting.push(enter_t[lane], node.children[lane]);
    }
  }
}

/// The closest hit below `from`.
template <class Counting>
std::optional<Hit> closest_below(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                                 TileChild from, const Ray& ray, Counting& counting) {
  ClosestHit best(ray);
  walk_ray(
      hierarchy, scene, from, ray, best.ray, counting, [&] { return best.ray.t_max; },
      [&](float t, scenes::PrimitiveId primitive) {
        best.keep(t, primitive);
        return false;
      });
  return best.result();
}

template <class Counting>
std::optional<Hit> closest(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                           const Ray& ray, Counting& counting) {
  return closest_below(hierarchy, scene, hierarchy.root, ray, counting);
}

/// Is there a hit below `from`?
template <class Counting>
bool any_below(const TileHierarchy& hierarchy, const scenes::Scene& scene, TileChild from,
               const Ray& ray, Counting& counting) {
  const CanonicalRay canonical(ray);
  bool found = false;
  walk_ray(
      hierarchy, scene, from, ray, canonical, counting, [&] { return ray.t_max; },
      [&](float t, scenes::PrimitiveId) {
        found = is_hit(t);
        return found;
      });
  return found;
}

template <class Counting>
bool any(const TileHierarchy& hierarchy, const scenes::Scene& scene, const Ray& ray,
         Counting& counting) {
  return any_below(hierarchy, scene, hierarchy.root, ray, counting);
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
