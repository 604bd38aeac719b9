// Traces single rays through the hierarchy: by float tests, which only reject, then by canonical
// tests.

#if defined(ACCEL_TILE_BEAM_RAY_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_RAY_WALK_INL
#undef ACCEL_TILE_BEAM_RAY_WALK_INL
#else
#define ACCEL_TILE_BEAM_RAY_WALK_INL
#endif

#include <bit>
#include <optional>
#include <span>

#include "accel/bvh/probe_ray.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/prefetch-inl.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Returns the boxes that a ray may meet before `limit`, and the t at which it enters them (see
/// ProbeRay).
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

/// Finds the triangles of a meshlet, from `first` on, that a ray may hit in [t_min, t_max].
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

/// The number of rays in flight at a time.
inline constexpr std::size_t kRaysAtOnce = 12;

/// The stack of pending entries: the bits of the entry t, which are ordered like floats, above
/// those of the child. The nearest is on top.
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
  /// Starts a group of entries that are sorted among themselves.
  void begin_siblings() { sorted_from_ = size_; }
  TileChild top() const {
    return TileChild::from_bits(static_cast<std::uint32_t>(entries_[size_ - 1]));
  }
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

/// Tests a leaf's primitives. `visit(t, primitive)` receives the result of each canonical test and
/// returns true to stop; hits beyond `t_max()` are irrelevant. Returns whether `visit` returned
/// true.
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

/// A query for the closest hit of a ray, and its result.
struct ClosestQuery {
  explicit ClosestQuery(const Ray& query) : best(query) {}

  const CanonicalRay& ray() const { return best.ray; }
  float t_max() const { return best.ray.t_max; }
  /// Takes the result of a canonical test; returns whether the traversal ends.
  bool take(float t, scenes::PrimitiveId primitive) {
    best.keep(t, primitive);
    return false;
  }
  std::optional<Hit> result() const { return best.result(); }

  ClosestHit best;
};

struct AnyQuery {
  explicit AnyQuery(const Ray& query) : canonical(query) {}

  const CanonicalRay& ray() const { return canonical; }
  float t_max() const { return canonical.t_max; }
  bool take(float t, scenes::PrimitiveId) {
    found = is_hit(t);
    return found;
  }
  bool result() const { return found; }

  CanonicalRay canonical;
  bool found = false;
};

/// A ray in flight through the hierarchy, nearest child first.
template <class Query>
class RayWalk {
 public:
  RayWalk(const TileHierarchy& hierarchy, TileChild from, const Ray& ray)
      : query_(ray), probe_(ray, hierarchy.bounds) {
    waiting_.push(ray.t_min, from);
  }

  /// Visits one node or leaf. Returns whether more are pending.
  template <class Counting>
  HWY_INLINE bool step(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                       Counting& counting) {
    float enter = 0.0F;
    const TileChild at = waiting_.pop(enter);
    if (enter > query_.t_max() * bvh::ProbeRay::kWider) return !waiting_.empty();
    counting.add(Counter::kTraversalSteps);
    counting.enter([&] {
      const scenes::Bounds box = bounds_of(hierarchy, at);
      return TraceStep{.place = at.kind() == TileChild::Kind::kNode ? "node" : "leaf",
                       .index = at.index(),
                       .box = Box{glm::dvec3(box.lower), glm::dvec3(box.upper)},
                       .t_enter = enter,
                       .t_exit = query_.t_max()};
    });
    if (at.kind() != TileChild::Kind::kNode) {
      counting.add(Counter::kLeaves);
      const bool ended = visit_leaf(
          hierarchy, scene, at, probe_, query_.ray(), counting, [&] { return query_.t_max(); },
          [&](float t, scenes::PrimitiveId primitive) { return query_.take(t, primitive); });
      return !ended && !waiting_.empty();
    }
    const TileNode& node = hierarchy.nodes[at.index()];
    counting.add(Counter::kBoxTests, node.count);
    alignas(64) std::array<float, kTileLanes> enter_t;
    waiting_.begin_siblings();
    for (LaneBits met = meet_boxes(node, probe_, query_.t_max(), enter_t.data()); met != 0;
         met &= met - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(met));
      waiting_.push(enter_t[lane], node.children[lane]);
    }
    return !waiting_.empty();
  }

  /// Returns the destination of the next step.
  TileChild next() const { return waiting_.top(); }
  auto result() const { return query_.result(); }

 private:
  Query query_;
  bvh::ProbeRay probe_;
  WaitingChildren waiting_;
};

template <class Query, class Counting>
auto answer_below(const TileHierarchy& hierarchy, const scenes::Scene& scene, TileChild from,
                  const Ray& ray, Counting& counting) {
  RayWalk<Query> walk(hierarchy, from, ray);
  while (walk.step(hierarchy, scene, counting)) {
  }
  return walk.result();
}

/// A traversal in flight, and the caller's number for its ray.
template <class Query>
struct NumberedWalk {
  NumberedWalk(std::size_t own, const TileHierarchy& hierarchy, TileChild from, const Ray& ray)
      : number(own), walk(hierarchy, from, ray) {}

  std::size_t number;
  RayWalk<Query> walk;
};

/// Traces several rays at once: in a hierarchy larger than the caches, nearly every step of a
/// single ray waits for memory, while the others continue. The interface is that of
/// `answer_rays_below`.
template <class Query, class Counting, class Next, class Done>
void interleave_rays_below(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                           TileChild from, Counting& counting, Next next, Done done) {
  std::array<std::optional<NumberedWalk<Query>>, kRaysAtOnce> rays;
  std::array<std::size_t, kRaysAtOnce> walking;  // places in `rays`
  std::size_t count = 0;
  Ray ray;
  std::size_t number = 0;
  while (count < kRaysAtOnce && next(ray, number)) {
    rays[count].emplace(number, hierarchy, from, ray);
    walking[count] = count;
    ++count;
  }
  while (count > 0) {
    for (std::size_t i = 0; i < count;) {
      NumberedWalk<Query>& one = *rays[walking[i]];
      if (one.walk.step(hierarchy, scene, counting)) {
        prefetch_for_ray(hierarchy, one.walk.next());
        ++i;
        continue;
      }
      done(one.number, one.walk.result());
      if (next(ray, number)) {
        rays[walking[i]].emplace(number, hierarchy, from, ray);
        ++i;
      } else {
        walking[i] = walking[--count];
      }
    }
  }
}

/// Traces rays in any order. `next(ray, number)` sets the next ray and a number chosen by the
/// caller, or returns false; `done(number, result)` receives its result.
template <class Query, class Counting, class Next, class Done>
void answer_rays_below(const TileHierarchy& hierarchy, const scenes::Scene& scene, TileChild from,
                       Counting& counting, Next next, Done done) {
  if (hierarchy.interleaves_rays) {
    return interleave_rays_below<Query>(hierarchy, scene, from, counting, next, done);
  }
  Ray ray;
  std::size_t number = 0;
  while (next(ray, number)) {
    done(number, answer_below<Query>(hierarchy, scene, from, ray, counting));
  }
}

/// Returns the closest hit below `from`.
template <class Counting>
std::optional<Hit> closest_below(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                                 TileChild from, const Ray& ray, Counting& counting) {
  return answer_below<ClosestQuery>(hierarchy, scene, from, ray, counting);
}

/// Returns whether there is a hit below `from`.
template <class Counting>
bool any_below(const TileHierarchy& hierarchy, const scenes::Scene& scene, TileChild from,
               const Ray& ray, Counting& counting) {
  return answer_below<AnyQuery>(hierarchy, scene, from, ray, counting);
}

template <class Counting>
std::optional<Hit> closest(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                           const Ray& ray, Counting& counting) {
  return closest_below(hierarchy, scene, hierarchy.root, ray, counting);
}

template <class Counting>
bool any(const TileHierarchy& hierarchy, const scenes::Scene& scene, const Ray& ray,
         Counting& counting) {
  return any_below(hierarchy, scene, hierarchy.root, ray, counting);
}

/// Calls `done(i, result)` for each ray of a list, in any order, except those that ProbeRay cannot
/// probe. Returns whether there are any such rays.
template <class Query, class Counting, class Done>
bool answer_list(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                 std::span<const Ray> rays, Counting& counting, Done done) {
  std::size_t following = 0;
  bool some_left = false;
  const auto next = [&](Ray& ray, std::size_t& i) {
    for (; following < rays.size(); ++following) {
      if (bvh::ProbeRay::can_probe(rays[following])) {
        i = following++;
        ray = rays[i];
        return true;
      }
      some_left = true;
    }
    return false;
  };
  answer_rays_below<Query>(hierarchy, scene, hierarchy.root, counting, next, done);
  return some_left;
}

template <class Counting>
bool closest_of_list(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                     std::span<const Ray> rays, const HitSpan& buffer, std::size_t first,
                     Counting& counting) {
  return answer_list<ClosestQuery>(
      hierarchy, scene, rays, counting,
      [&](std::size_t i, const std::optional<Hit>& hit) { buffer.set(first + i, hit); });
}

template <class Counting>
bool any_of_list(const TileHierarchy& hierarchy, const scenes::Scene& scene,
                 std::span<const Ray> rays, std::span<std::uint8_t> hits, Counting& counting) {
  return answer_list<AnyQuery>(hierarchy, scene, rays, counting,
                               [&](std::size_t i, bool hit) { hits[i] = hit ? 1 : 0; });
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
