// The rays of a part of a pencil, through one side of the cube about its apex, through the
// hierarchy.

#if defined(ACCEL_TILE_BEAM_PENCIL_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_WALK_INL
#undef ACCEL_TILE_BEAM_PENCIL_WALK_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_WALK_INL
#endif

#include <bit>

#include <hwy/cache_control.h>

#include "accel/core/intersect.hpp"
#include "accel/tile_beam/hand_over.hpp"
#include "accel/tile_beam/pencil_shapes-inl.hpp"
#include "accel/tile_beam/ray_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Rays toward the apex: a hit ends a ray.
struct AnyHitPolicy {
  static constexpr bool kClosest = false;
  static constexpr bool kFar = false;
  static constexpr bool kDense = false;
  /// Leaves for each ray from which on single rays take less time, measured.
  static constexpr float kHandoverLeaves = 1.0F;
};
/// The same from an apex so far away that float is not sure of a hit close to a ray's origin:
/// these are confirmed.
struct FarAnyHitPolicy : AnyHitPolicy {
  static constexpr bool kFar = true;
};
/// The same for rays so close together that float is not sure of many hits at a triangle's edge
/// either: these are confirmed, too.
struct DenseAnyHitPolicy : FarAnyHitPolicy {
  static constexpr bool kDense = true;
};
/// Rays away from the apex: a hit brings the ray's end nearer.
struct ClosestHitPolicy {
  static constexpr bool kClosest = true;
  static constexpr bool kFar = false;
  static constexpr bool kDense = false;
  static constexpr float kHandoverLeaves = 3.0F;
};

/// Parts of so few leaves are not worth counting rays for.
inline constexpr std::uint32_t kFewLeaves = 2;

template <class Policy, class Counting>
class PencilWalk {
 public:
  PencilWalk(const TileHierarchy& hierarchy, const scenes::Scene& scene, const PencilPart& part,
             CubeSide side, PencilUnit& unit, Counting& counting)
      : hierarchy_(&hierarchy),
        scene_(&scene),
        part_(&part),
        view_{part.apex, side, hierarchy.bounds.largest_coordinate()},
        unit_(&unit),
        counting_(&counting) {}

  void operator()() {
    for (std::size_t group = 0; group < PencilUnit::kGroups; ++group) {
      if (group < unit_->groups) {
        int rays = 0;
        for (std::size_t i = 0; i < 16; ++i) {
          rays += std::popcount(std::uint32_t{unit_->alive[group * 16 + i]});
        }
        unit_->group_rays[group] = static_cast<float>(rays);
        bound_group(group);
        unit_->group_area[group] = (unit_->group_high_u[group] - unit_->group_low_u[group]) *
                                   (unit_->group_high_v[group] - unit_->group_low_v[group]);
      } else {
        drop_group(group);
      }
    }
    bound_all();
    if (unit_->groups_alive == 0) return;
    // Over all of the scene the estimate is coarse: only a part that is clearly crowded is handed
    // over whole, which a look at the children would decide better but not for nothing.
    const auto half = static_cast<std::uint32_t>(hierarchy_->leaves() / 2);
    stack_[0] = {hierarchy_->root, unit_->groups_alive,
                 is_crowded(half, unit_->groups_alive, bounds_of_all()), kEverywhere};
    size_ = 1;
    while (size_ > 0) {
      const Entry entry = stack_[--size_];
      const std::uint32_t groups = entry.groups & unit_->groups_alive;
      if (groups == 0) continue;
      if constexpr (kClosest) {
        if (entry.bounds[kHighW] < all_.least_w) continue;
      }
      counting_->add(Counter::kTraversalSteps);
      if (entry.crowded) {
        hand_over(entry, groups);
      } else if (entry.child.kind() == TileChild::Kind::kNode) {
        push_children(hierarchy_->nodes[entry.child.index()], groups);
      } else {
        visit_leaf(entry, groups);
      }
    }
  }

 private:
  static constexpr bool kClosest = Policy::kClosest;

  static constexpr std::array<float, 6> kEverywhere{-kAtApex, kAtApex,  -kAtApex,
                                                    kAtApex,  -kAtApex, kAtApex};
  enum Bound : std::size_t { kLowU, kHighU, kLowV, kHighV, kLowW, kHighW };
  struct Entry {
    TileChild child;
    std::uint32_t groups;  ///< that it may be seen from, a bit each
    bool crowded;          ///< more leaves than single rays would take
    std::array<float, 6> bounds;
  };

  // ---- bounds -----------------------------------------------------------------------------------

  HWY_INLINE void drop_group(std::size_t group) {
    unit_->group_blocks[group] = 0;
    unit_->group_low_u[group] = unit_->group_low_v[group] = unit_->group_w[group] = kInfinity;
    unit_->group_high_u[group] = unit_->group_high_v[group] = -kInfinity;
    unit_->group_origin_w[group] = -kInfinity;
    unit_->groups_alive &= ~(1U << group);
  }

  HWY_INLINE void bound_group(std::size_t group) {
    const std::size_t first = group * 16;
    Floats low_u = all(-kInfinity), high_u = low_u, low_v = low_u, high_v = low_u, w = low_u,
           origin_w = low_u;
    for (std::size_t lane = 0; lane < 16; lane += kLanes) {
      const Mask in = lanes_of(unit_->group_blocks[group], lane);
      const auto most = [&](Floats& sum, const auto& values) {
        sum = hn::Max(sum, hn::IfThenElse(in, load(&values[first + lane]), all(-kInfinity)));
      };
      most(low_u, unit_->minus_low_u);
      most(high_u, unit_->high_u);
      most(low_v, unit_->minus_low_v);
      most(high_v, unit_->high_v);
      most(w, unit_->minus_w);
      if constexpr (kClosest) most(origin_w, unit_->origin_w_top);
    }
    unit_->group_low_u[group] = -most_of(low_u);
    unit_->group_high_u[group] = most_of(high_u);
    unit_->group_low_v[group] = -most_of(low_v);
    unit_->group_high_v[group] = most_of(high_v);
    unit_->group_w[group] = -most_of(w);
    if constexpr (kClosest) unit_->group_origin_w[group] = most_of(origin_w);
  }

  HWY_INLINE void bound_all() {
    Floats low_u = all(kInfinity), high_u = all(-kInfinity), low_v = low_u, high_v = high_u,
           w = low_u, origin_w = high_u;
    for (std::size_t lane = 0; lane < PencilUnit::kGroups; lane += kLanes) {
      low_u = hn::Min(low_u, load(&unit_->group_low_u[lane]));
      high_u = hn::Max(high_u, load(&unit_->group_high_u[lane]));
      low_v = hn::Min(low_v, load(&unit_->group_low_v[lane]));
      high_v = hn::Max(high_v, load(&unit_->group_high_v[lane]));
      w = hn::Min(w, load(&unit_->group_w[lane]));
      if constexpr (kClosest) origin_w = hn::Max(origin_w, load(&unit_->group_origin_w[lane]));
    }
    all_ = {least_of(low_u), most_of(high_u), least_of(low_v),
            most_of(high_v), least_of(w),     kClosest ? most_of(origin_w) : kInfinity};
  }

  // ---- the hierarchy ----------------------------------------------------------------------------

  /// Lanes whose bounds overlap those of `within` (sign clear).
  static HWY_INLINE Floats apart(const SeenBounds& bounds, const PencilBounds& within) {
    const Floats aside =
        either(hn::Sub(bounds.high_u, all(within.low_u)), hn::Sub(all(within.high_u), bounds.low_u),
               hn::Sub(bounds.high_v, all(within.low_v)));
    const Floats behind = hn::Sub(bounds.high_w, all(within.least_w));
    const Floats rest = hn::Sub(all(within.high_v), bounds.low_v);
    if constexpr (kClosest) {
      return either(aside, hn::Or(behind, rest), hn::Sub(all(within.most_origin_w), bounds.low_w));
    } else {
      return either(aside, behind, rest);
    }
  }

  HWY_INLINE void push_children(const TileNode& node, std::uint32_t groups) {
    counting_->add(Counter::kBoxTests, node.count);
    alignas(64) std::array<std::array<float, kTileLanes>, 6> stored;
    LaneBits met = for_each_register([&](std::size_t lane) {
      Mask seen;
      const SeenBounds bounds = bounds_of(node.boxes, lane, view_, seen);
      store(bounds.low_u, &stored[kLowU][lane]);
      store(bounds.high_u, &stored[kHighU][lane]);
      store(bounds.low_v, &stored[kLowV][lane]);
      store(bounds.high_v, &stored[kHighV][lane]);
      store(bounds.low_w, &stored[kLowW][lane]);
      store(bounds.high_w, &stored[kHighW][lane]);
      return hn::AndNot(is_negative(apart(bounds, all_)), seen);
    });
    met &= (LaneBits{1} << node.count) - 1;
    const std::size_t first = size_;
    for (; met != 0; met &= met - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(met));
      const std::array<float, 6> bounds{stored[kLowU][lane], stored[kHighU][lane],
                                        stored[kLowV][lane], stored[kHighV][lane],
                                        stored[kLowW][lane], stored[kHighW][lane]};
      const std::uint32_t seen = groups & groups_in(bounds);
      if (seen == 0) continue;
      prefetch(node.children[lane]);
      std::size_t hole = size_++;
      if constexpr (kClosest) {  // the nearest is on top
        for (; hole > first && stack_[hole - 1].bounds[kHighW] > bounds[kHighW]; --hole) {
          stack_[hole] = stack_[hole - 1];
        }
      }
      stack_[hole] = {node.children[lane], seen, is_crowded(node.leaves[lane], seen, bounds),
                      bounds};
    }
  }

  /// Of the whole hierarchy.
  std::array<float, 6> bounds_of_all() const {
    TileBoxes boxes{};
    boxes.set(0, hierarchy_->bounds);
    Mask seen;
    const SeenBounds bounds = bounds_of(boxes, 0, view_, seen);
    return {hn::GetLane(bounds.low_u),  hn::GetLane(bounds.high_u), hn::GetLane(bounds.low_v),
            hn::GetLane(bounds.high_v), hn::GetLane(bounds.low_w),  hn::GetLane(bounds.high_w)};
  }

  /// A part of the hierarchy with more leaves than `kHandoverLeaves` for each ray that may
  /// meet it is traversed by single rays, which need a few leaves each. How many these would be is
  /// estimated from how densely the rays of the groups lie, over all of its bounds: most leaves of
  /// a large part may lie beyond the groups.
  HWY_INLINE bool is_crowded(std::uint32_t leaves, std::uint32_t groups,
                             const std::array<float, 6>& bounds) const {
    if (leaves < kFewLeaves) return false;
    Floats rays = hn::Zero(Tag());
    Floats areas = hn::Zero(Tag());
    for (std::size_t lane = 0; lane < unit_->groups; lane += kLanes) {
      const Mask in = lanes_of(groups >> lane, 0);
      const Floats none = hn::Zero(Tag());
      rays = hn::Add(rays, hn::IfThenElse(in, load(&unit_->group_rays[lane]), none));
      areas = hn::Add(areas, hn::IfThenElse(in, load(&unit_->group_area[lane]), none));
    }
    // The side ends at +-1.
    const auto extent = [&](Bound low, Bound high) {
      return std::min(bounds[high], 1.0F) - std::max(bounds[low], -1.0F);
    };
    const float area = extent(kLowU, kHighU) * extent(kLowV, kHighV);
    const float all_rays = hn::GetLane(hn::SumOfLanes(Tag(), rays));
    const float all_areas = hn::GetLane(hn::SumOfLanes(Tag(), areas));
    return static_cast<float>(leaves) * all_areas >
           Policy::kHandoverLeaves * (all_rays * area + all_areas);
  }

  /// Single rays for those that are left.
  void hand_over(const Entry& entry, std::uint32_t groups) {
    changed_ = 0;
    for (; groups != 0; groups &= groups - 1) {
      const auto group = static_cast<std::size_t>(std::countr_zero(groups));
      for (LaneBits blocks = blocks_in(group, entry.bounds); blocks != 0; blocks &= blocks - 1) {
        hand_over(entry, group * 16 + static_cast<std::size_t>(std::countr_zero(blocks)));
      }
    }
    if (changed_ != 0) update();
  }

  void hand_over(const Entry& entry, std::size_t place) {
    const std::array<float, 6>& bounds = entry.bounds;
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    LaneBits inside = for_each_register([&](std::size_t lane) {
      const std::size_t at = block + lane;
      const auto within = [](Floats value, float low, float high) {
        return hn::And(hn::Ge(value, all(low - kPlacePad)), hn::Le(value, all(high + kPlacePad)));
      };
      return hn::And(hn::And(within(load(&unit_->u[at]), bounds[kLowU], bounds[kHighU]),
                             within(load(&unit_->v[at]), bounds[kLowV], bounds[kHighV])),
                     hn::Le(load(&unit_->w[at]), all(bounds[kHighW])));
    });
    inside &= unit_->alive[place];
    LaneBits hits = 0;
    for (LaneBits left = inside; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      note_handed_over(*counting_, block + lane);
      if (finds_below(entry.child, block + lane)) hits |= LaneBits{1} << lane;
    }
    changed_ |= note(place, hits);
  }

  /// Traces the ray of a place in the unit through a part of the hierarchy.
  bool finds_below(TileChild from, std::size_t at) {
    const Ray& ray = part_->rays[unit_->ray_at(at)];
    if constexpr (kClosest) {
      const auto hit = closest_below(*hierarchy_, *scene_, from, ray, *counting_);
      return hit && keeps(at, ray, *hit);
    } else {
      return any_below(*hierarchy_, *scene_, from, ray, *counting_);
    }
  }

  /// Closest hits: is this one the nearest so far? It is kept then.
  bool keeps(std::size_t at, const Ray& ray, const Hit& hit) {
    const auto z = static_cast<int>(view_.side.z_axis());
    const float origin = (ray.origin[z] - view_.apex[z]) * view_.side.sign();
    const float w = 1.0F / (origin + hit.t * ray.direction[z] * view_.side.sign());
    if (!(w > unit_->w[at])) return false;
    unit_->w[at] = w;
    unit_->primitive[at] = hit.primitive;
    return true;
  }

  /// The groups from which bounds may be seen.
  HWY_INLINE std::uint32_t groups_in(const std::array<float, 6>& bounds) const {
    std::uint32_t bits = 0;
    for (std::size_t lane = 0; lane < unit_->groups; lane += kLanes) {
      Floats out = either(hn::Sub(load(&unit_->group_high_u[lane]), all(bounds[kLowU])),
                          hn::Sub(all(bounds[kHighU]), load(&unit_->group_low_u[lane])),
                          hn::Sub(load(&unit_->group_high_v[lane]), all(bounds[kLowV])));
      out = either(out, hn::Sub(all(bounds[kHighV]), load(&unit_->group_low_v[lane])),
                   hn::Sub(all(bounds[kHighW]), load(&unit_->group_w[lane])));
      if constexpr (kClosest) {
        out = hn::Or(out, hn::Sub(load(&unit_->group_origin_w[lane]), all(bounds[kLowW])));
      }
      bits |= bits_of(hn::Not(is_negative(out))) << lane;
    }
    return bits;
  }

  HWY_INLINE void prefetch(TileChild child) const {
    const auto fetch = [](const auto& block) {
      const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&block);
      for (std::size_t i = 0; i < sizeof(block); i += 64) hwy::Prefetch(bytes + i);
    };
    if (child.kind() == TileChild::Kind::kNode) {
      fetch(hierarchy_->nodes[child.index()]);
    } else if (child.kind() == TileChild::Kind::kMeshlet) {
      fetch(hierarchy_->meshlets[child.index()]);
    }
  }

  // ---- leaves -----------------------------------------------------------------------------------

  void count_tests(scenes::PrimitiveKind kind) {
    counting_->add_tests(kind, tests_count_ * PencilUnit::kBlock);
  }

  HWY_INLINE void visit_leaf(const Entry& entry, std::uint32_t groups) {
    counting_->add(Counter::kLeaves);
    changed_ = 0;
    switch (entry.child.kind()) {
      case TileChild::Kind::kMeshlet: {
        const Meshlet& meshlet = hierarchy_->meshlets[entry.child.index()];
        TriangleShapes(meshlet, view_, shapes_)(all_);
        if (shapes_.present == 0) return;
        find_pairs(entry, groups, meshlet.triangle_count);
        test_blocks<true>(meshlet.triangle_count);
        count_tests(scenes::PrimitiveKind::kPolygon);
        test_triangles(meshlet);
        break;
      }
      case TileChild::Kind::kSpheres: {
        const SphereBlock& block = hierarchy_->spheres[entry.child.index()];
        set_up_spheres(block, view_, sphere_slack(), shapes_);
        if (shapes_.present == 0) return;
        find_pairs(entry, groups, block.count);
        test_blocks<false>(block.count);
        count_tests(scenes::PrimitiveKind::kSphere);
        test_spheres(block);
        break;
      }
      case TileChild::Kind::kCones: {
        const ConeBlock& block = hierarchy_->cones[entry.child.index()];
        set_up_cones(block, view_, shapes_);
        if (shapes_.present == 0) return;
        find_pairs(entry, groups, block.count);
        test_blocks<false>(block.count);
        count_tests(scenes::PrimitiveKind::kCone);
        for (std::size_t i = 0; i < tests_count_; ++i) {
          const scenes::PrimitiveId id = block.primitives[tests_[i] % SeenShapes::kMost];
          const scenes::Cone& cone = scene_->cones[scene_->primitives[id].index];
          changed_ |= test_by_rays(tests_[i] / SeenShapes::kMost, id, [&](const CanonicalRay& ray) {
            return intersect_cone(ray, cone);
          });
        }
        break;
      }
      case TileChild::Kind::kNode:
        break;
    }
    if (changed_ != 0) update();
  }

  float sphere_slack() const { return 0x1p-20F * view_.scene_size; }

  /// The blocks of a group that something within bounds may be seen from.
  HWY_INLINE LaneBits blocks_in(std::size_t group, const std::array<float, 6>& bounds) const {
    const LaneBits blocks = for_each_register([&](std::size_t lane) {
      const std::size_t at = group * 16 + lane;
      Floats out = either(hn::Sub(load(&unit_->high_u[at]), all(bounds[kLowU])),
                          hn::Add(load(&unit_->minus_low_u[at]), all(bounds[kHighU])),
                          hn::Sub(load(&unit_->high_v[at]), all(bounds[kLowV])));
      out = either(out, hn::Add(load(&unit_->minus_low_v[at]), all(bounds[kHighV])),
                   hn::Add(load(&unit_->minus_w[at]), all(bounds[kHighW])));
      return hn::Not(is_negative(out));
    });
    return blocks & unit_->group_blocks[group];
  }

  using Numbers = hn::Vec<hn::RebindToUnsigned<Tag>>;

  /// Writes the numbers of some lanes one after the other, and returns how many. A whole register
  /// is written: storing a part of it takes some processors a hundred cycles.
  static HWY_INLINE std::size_t append(Numbers numbers, Mask which, std::uint32_t* to) {
    const hn::RebindToUnsigned<Tag> d;
    const auto mask = hn::RebindMask(d, which);
    hn::StoreU(hn::Compress(numbers, mask), d, to);
    return hn::CountTrue(d, mask);
  }

  /// Which shapes are to be tested with which blocks: of each group either all blocks against some
  /// shapes, or all shapes against some blocks, whatever is fewer.
  HWY_INLINE void find_pairs(const Entry& entry, std::uint32_t groups, std::size_t count) {
    const hn::RebindToUnsigned<Tag> d;
    std::size_t by_shape_count = 0;
    std::size_t by_block_count = 0;
    const std::size_t shape_registers = (count + kLanes - 1) / kLanes;
    for (; groups != 0; groups &= groups - 1) {
      const auto group = static_cast<std::size_t>(std::countr_zero(groups));
      const std::size_t first = group * 16;
      const LaneBits blocks = blocks_in(group, entry.bounds);
      const PencilBounds bounds{unit_->group_low_u[group], unit_->group_high_u[group],
                                unit_->group_low_v[group], unit_->group_high_v[group],
                                unit_->group_w[group],     unit_->group_origin_w[group]};
      LaneBits shapes = 0;
      for (std::size_t lane = 0; lane < count; lane += kLanes) {
        const SeenBounds seen{
            shapes_.at(SeenShapes::kLowU, lane), shapes_.at(SeenShapes::kHighU, lane),
            shapes_.at(SeenShapes::kLowV, lane), shapes_.at(SeenShapes::kHighV, lane),
            shapes_.at(SeenShapes::kLowW, lane), shapes_.at(SeenShapes::kHighW, lane)};
        shapes |= bits_of(hn::Not(is_negative(apart(seen, bounds)))) << lane;
      }
      shapes &= shapes_.present;
      // Both lists grow without a branch: the one that is not chosen by nothing.
      const std::size_t registers_of_group = 16 / kLanes;
      const bool by_block = static_cast<std::size_t>(std::popcount(blocks)) * shape_registers <
                            static_cast<std::size_t>(std::popcount(shapes)) * registers_of_group;
      const LaneBits some_blocks = by_block ? blocks : 0;
      const LaneBits some_shapes = by_block || blocks == 0 ? 0 : shapes;
      for (std::size_t lane = 0; lane < 16; lane += kLanes) {
        by_block_count += append(hn::Iota(d, static_cast<std::uint32_t>(first + lane)),
                                 lanes_of(some_blocks, lane), &by_block_[by_block_count]);
      }
      for (std::size_t lane = 0; lane < count; lane += kLanes) {
        by_shape_count +=
            append(hn::Iota(d, static_cast<std::uint32_t>(group * SeenShapes::kMost + lane)),
                   lanes_of(some_shapes, lane), &by_shape_[by_shape_count]);
      }
    }
    by_shape_count_ = by_shape_count;
    by_block_count_ = by_block_count;
  }

  /// Numbers of a shape, all lanes alike, or of as many shapes as there are lanes; likewise blocks.
  struct OneShape {
    const SeenShapes& shapes;
    std::size_t shape;
    HWY_INLINE Floats operator()(std::size_t row) const { return all(shapes.rows[row][shape]); }
  };
  struct SomeShapes {
    const SeenShapes& shapes;
    std::size_t lane;
    HWY_INLINE Floats operator()(std::size_t row) const { return shapes.at(row, lane); }
  };
  struct OneBlock {
    std::size_t place;
    HWY_INLINE Floats operator()(const float* values) const { return all(values[place]); }
  };
  struct SomeBlocks {
    std::size_t place;
    HWY_INLINE Floats operator()(const float* values) const { return load(values + place); }
  };

  /// Lanes where the shape can hit no ray of the block have their sign set.
  template <bool kTriangles, class Shape, class Block>
  HWY_INLINE Floats misses(Shape shape, Block block) const {
    const PencilUnit& unit = *unit_;
    Floats out = either(hn::Sub(block(unit.high_u.data()), shape(SeenShapes::kLowU)),
                        hn::Add(block(unit.minus_low_u.data()), shape(SeenShapes::kHighU)),
                        hn::Sub(block(unit.high_v.data()), shape(SeenShapes::kLowV)));
    const Floats minus_w = block(unit.minus_w.data());
    out = either(out, hn::Add(block(unit.minus_low_v.data()), shape(SeenShapes::kHighV)),
                 hn::Add(minus_w, shape(SeenShapes::kHighW)));
    if constexpr (kClosest) {
      out = hn::Or(out, hn::Sub(block(unit.origin_w_top.data()), shape(SeenShapes::kLowW)));
    }
    if constexpr (kTriangles) {
      const Floats middle_u = block(unit.middle_u.data());
      const Floats middle_v = block(unit.middle_v.data());
      const Floats half_u = block(unit.half_u.data());
      const Floats half_v = block(unit.half_v.data());
      // The largest value of a line over the block.
      const auto largest = [&](std::size_t row, std::size_t magnitudes, Floats constant) {
        return hn::MulAdd(
            shape(row), middle_u,
            hn::MulAdd(shape(row + 1), middle_v,
                       hn::MulAdd(shape(magnitudes), half_u,
                                  hn::MulAdd(shape(magnitudes + 1), half_v, constant))));
      };
      const auto edge = [&](std::size_t k) {
        return largest(SeenShapes::kEdge0 + 3 * k, SeenShapes::kMagnitudes + 2 * k,
                       shape(SeenShapes::kEdge0 + 3 * k + 2));
      };
      out = either(out, edge(0), edge(1));
      out = either(out, edge(2),
                   largest(SeenShapes::kPlane, SeenShapes::kMagnitudes + 6,
                           hn::MulAdd(shape(SeenShapes::kDistance), minus_w,
                                      shape(SeenShapes::kPlane + 2))));
    }
    return out;
  }

  /// Lists the pairs of a block and a shape whose rays are to be tested.
  template <bool kTriangles>
  HWY_INLINE void test_blocks(std::size_t count) {
    const hn::RebindToUnsigned<Tag> d;
    std::size_t count_of_tests = 0;
    const std::size_t by_shapes = by_shape_count_;
    const std::size_t by_blocks = by_block_count_;
    constexpr auto kMost = static_cast<std::uint32_t>(SeenShapes::kMost);
    for (std::size_t i = 0; i < by_shapes; ++i) {
      const std::size_t shape = by_shape_[i] % kMost;
      const std::size_t first = by_shape_[i] / kMost * 16;
      for (std::size_t lane = 0; lane < 16; lane += kLanes) {
        const Mask hit = hn::Not(
            is_negative(misses<kTriangles>(OneShape{shapes_, shape}, SomeBlocks{first + lane})));
        const auto pair = hn::ShiftLeft<5>(hn::Iota(d, static_cast<std::uint32_t>(first + lane)));
        count_of_tests += append(hn::Or(pair, hn::Set(d, static_cast<std::uint32_t>(shape))), hit,
                                 &tests_[count_of_tests]);
      }
    }
    for (std::size_t i = 0; i < by_blocks; ++i) {
      const std::uint32_t place = by_block_[i];
      for (std::size_t lane = 0; lane < count; lane += kLanes) {
        const Mask hit =
            hn::AndNot(is_negative(misses<kTriangles>(SomeShapes{shapes_, lane}, OneBlock{place})),
                       lanes_of(shapes_.present >> lane, 0));
        count_of_tests += append(hn::Iota(d, place * kMost + static_cast<std::uint32_t>(lane)), hit,
                                 &tests_[count_of_tests]);
      }
    }
    tests_count_ = count_of_tests;
  }

  HWY_INLINE void test_triangles(const Meshlet& meshlet) {
    const LaneBits special = shapes_.exact | shapes_.by_rays;
    const std::size_t count = tests_count_;
    std::uint32_t changed = 0;  // in a register: the next test would wait for it in memory
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t place = tests_[i] / SeenShapes::kMost;
      const std::size_t shape = tests_[i] % SeenShapes::kMost;
      if ((special >> shape & 1U) != 0) [[unlikely]] {
        changed |= test_specially(place, shape, meshlet);
      } else {
        Unsure unsure;
        LaneBits hits = test_triangle(place, shape, meshlet.primitives[shape], unsure);
        if (Policy::kFar && unsure.depth != 0) [[unlikely]] {
          hits = confirmed(place, hits, unsure.depth, crosses_plane_of(meshlet, shape));
        }
        if (Policy::kDense && (unsure.edge & hits) != 0) [[unlikely]] {
          hits = decided_by_rays(place, hits, unsure.edge);
        }
        changed |= note(place, hits);
      }
    }
    changed_ |= changed;
  }

  /// Hits of a triangle that float is not sure of.
  struct Unsure {
    LaneBits depth = 0;  ///< close to a ray's origin
    LaneBits edge = 0;   ///< close to an edge, which was moved outward
  };

  /// The rays of a block that hit a triangle, and which of these hits are uncertain.
  HWY_INLINE LaneBits test_triangle(std::size_t place, std::size_t shape,
                                    scenes::PrimitiveId primitive, Unsure& unsure) {
    const OneShape of{shapes_, shape};
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    return for_each_register([&](std::size_t lane) {
      const Floats u = load(&unit_->u[block + lane]);
      const Floats v = load(&unit_->v[block + lane]);
      const Floats w = load(&unit_->w[block + lane]);
      const auto line = [&](std::size_t row, Floats constant) {
        return hn::MulAdd(of(row), u, hn::MulAdd(of(row + 1), v, constant));
      };
      const auto edge = [&](std::size_t k) {
        return line(SeenShapes::kEdge0 + 3 * k, of(SeenShapes::kEdge0 + 3 * k + 2));
      };
      const Floats outside = either(edge(0), edge(1), edge(2));
      const Floats distance = of(SeenShapes::kDistance);
      if constexpr (kClosest) {
        const Floats plane = line(SeenShapes::kPlane, of(SeenShapes::kPlane + 2));
        const Floats before = hn::NegMulAdd(distance, w, plane);
        const Floats after = hn::MulSub(distance, load(&unit_->origin_w[block + lane]), plane);
        const Mask hit = hn::AndNot(is_negative(either(outside, before, after)),
                                    lanes_of(unit_->alive[place], lane));
        if (!hn::AllFalse(Tag(), hit)) {
          keep(block + lane, hit, hn::Div(plane, distance), w, primitive);
        }
        return hit;
      } else {
        const Floats beyond =
            line(SeenShapes::kPlane, hn::NegMulAdd(distance, w, of(SeenShapes::kPlane + 2)));
        const Mask hit = hn::Not(is_negative(hn::Or(outside, beyond)));
        if constexpr (Policy::kFar) {
          const Floats clearly = hn::NegMulAdd(hn::Mul(distance, w), all(kDepthRounding), beyond);
          const Mask close = hn::And(hit, is_negative(clearly));
          unsure.depth |= (bits_of(close) << lane) & unit_->alive[place];
        }
        if constexpr (Policy::kDense) {
          const auto inside = [&](std::size_t k) {
            const std::size_t row = SeenShapes::kMagnitudes + 2 * k;
            return hn::NegMulAdd(hn::Add(of(row), of(row + 1)), all(kEdgeRounding), edge(k));
          };
          const Mask at_edge = hn::And(hit, is_negative(either(inside(0), inside(1), inside(2))));
          unsure.edge |= (bits_of(at_edge) << lane) & unit_->alive[place];
        }
        return hit;
      }
    });
  }

  /// Any hits, of which those at an edge are decided by single rays through the whole hierarchy:
  /// where triangles share the edge, another test of one of them alone could lose the ray between.
  LaneBits decided_by_rays(std::size_t place, LaneBits hits, LaneBits unsure) {
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    for (LaneBits left = hits & unsure; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      note_handed_over(*counting_, block + lane);
      if (!finds_below(hierarchy_->root, block + lane)) hits &= ~(LaneBits{1} << lane);
    }
    return hits;
  }

  /// A triangle that float is too coarse for.
  std::uint32_t test_specially(std::size_t place, std::size_t shape, const Meshlet& meshlet) {
    const scenes::PrimitiveId primitive = meshlet.primitives[shape];
    if ((shapes_.exact >> shape & 1U) == 0) {
      return test_by_rays(place, primitive, [&](const CanonicalRay& ray) {
        return intersect_triangle(ray, meshlet.corner(0, shape), meshlet.corner(1, shape),
                                  meshlet.corner(2, shape));
      });
    }
    Unsure unsure;
    LaneBits hits = test_exact_triangle(place, shapes_.exact_triangle[shape], primitive, unsure);
    if (Policy::kFar) hits = confirmed(place, hits, hits, crosses_plane_of(meshlet, shape));
    // Seen edge-on, a sliver is not wider than its edges were moved.
    if (!kClosest) hits = decided_by_rays(place, hits, unsure.edge);
    return note(place, hits);
  }

  /// Of depth alone: where triangles share an edge, one must not be tested in float and the other
  /// in double for which of them a ray passes.
  static auto crosses_plane_of(const Meshlet& meshlet, std::size_t shape) {
    return [&meshlet, shape](const Ray& ray) {
      return crosses_plane(
          ray, {meshlet.corner(0, shape), meshlet.corner(1, shape), meshlet.corner(2, shape)});
    };
  }

  /// The hits to be confirmed: where the ray begins within the roundings of its depth of the
  /// surface.
  LaneBits unsure_of_sphere(std::size_t place, std::size_t shape) const {
    const OneShape of{shapes_, shape};
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    return for_each_register([&](std::size_t lane) {
      const Floats depth = hn::Div(all(1.0F), load(&unit_->w[block + lane]));
      const Points begin{
          hn::MulSub(load(&unit_->u[block + lane]), depth, of(SeenShapes::kCenter)),
          hn::MulSub(load(&unit_->v[block + lane]), depth, of(SeenShapes::kCenter + 1)),
          hn::Sub(depth, of(SeenShapes::kCenter + 2))};
      const Floats reach = hn::MulAdd(depth, all(kDepthRounding), of(SeenShapes::kRadius));
      return hn::Lt(dot(begin, begin), hn::Mul(reach, reach));
    });
  }

  /// Any hits, of which `is_hit_by(ray)` decides some.
  template <class IsHit>
  LaneBits confirmed(std::size_t place, LaneBits hits, LaneBits unsure, IsHit is_hit_by) const {
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    for (LaneBits left = hits & unsure & unit_->alive[place]; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      if (!is_hit_by(part_->rays[unit_->ray_at(block + lane)])) hits &= ~(LaneBits{1} << lane);
    }
    return hits;
  }

  LaneBits test_exact_triangle(std::size_t place, const ExactApexTriangle& triangle,
                               scenes::PrimitiveId primitive, Unsure& unsure) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> half;
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    LaneBits hits = 0;
    alignas(64) std::array<float, PencilUnit::kBlock> found_w;
    for (std::size_t lane = 0; lane < PencilUnit::kBlock; lane += hn::Lanes(d)) {
      const auto u = hn::PromoteTo(d, hn::Load(half, &unit_->u[block + lane]));
      const auto v = hn::PromoteTo(d, hn::Load(half, &unit_->v[block + lane]));
      const auto w = hn::PromoteTo(d, hn::Load(half, &unit_->w[block + lane]));
      const auto line = [&](const glm::dvec3& numbers) {
        return hn::MulAdd(hn::Set(d, numbers.x), u,
                          hn::MulAdd(hn::Set(d, numbers.y), v, hn::Set(d, numbers.z)));
      };
      const auto none = hn::Zero(d);
      const auto plane = line(triangle.plane);
      const auto distance = hn::Set(d, triangle.distance);
      const std::array edges{line(triangle.edges[0]), line(triangle.edges[1]),
                             line(triangle.edges[2])};
      auto hit = hn::And(hn::And(hn::Ge(edges[0], none), hn::Ge(edges[1], none)),
                         hn::And(hn::Ge(edges[2], none), hn::Gt(plane, hn::Mul(distance, w))));
      const auto within = [&](auto place, double low, double high) {
        return hn::And(hn::Ge(place, hn::Set(d, low)), hn::Le(place, hn::Set(d, high)));
      };
      hit = hn::And(hit, hn::And(within(u, triangle.low.x, triangle.high.x),
                                 within(v, triangle.low.y, triangle.high.y)));
      if constexpr (kClosest) {
        const auto origin_w = hn::PromoteTo(d, hn::Load(half, &unit_->origin_w[block + lane]));
        hit = hn::And(hit, hn::Lt(plane, hn::Mul(distance, origin_w)));
        hn::Store(hn::DemoteTo(half, hn::Div(plane, distance)), half, &found_w[lane]);
      }
      const auto bits = [&](auto mask) {
        std::array<std::uint8_t, 8> stored{};
        hn::StoreMaskBits(d, mask, stored.data());
        return static_cast<LaneBits>(stored[0]) << lane;
      };
      hits |= bits(hit);
      for (std::size_t k = 0; k < 3; ++k) {
        unsure.edge |= bits(hn::Lt(edges[k], hn::Set(d, triangle.clear[k])));
      }
    }
    hits &= unit_->alive[place];
    if constexpr (kClosest) {
      for (std::size_t lane = 0; lane < PencilUnit::kBlock; lane += kLanes) {
        const Floats w = load(&unit_->w[block + lane]);
        keep(block + lane, lanes_of(hits >> lane, 0), load(&found_w[lane]), w, primitive);
      }
    }
    return hits;
  }

  HWY_INLINE void test_spheres(const SphereBlock& block) {
    for (std::size_t i = 0; i < tests_count_; ++i) {
      const std::size_t place = tests_[i] / SeenShapes::kMost;
      const std::size_t shape = tests_[i] % SeenShapes::kMost;
      const scenes::PrimitiveId id = block.primitives[shape];
      const auto intersect = [&](const CanonicalRay& ray) {
        return intersect_sphere(ray, scene_->spheres[scene_->primitives[id].index]);
      };
      if ((shapes_.by_rays >> shape & 1U) != 0) {
        changed_ |= test_by_rays(place, id, intersect);
      } else {
        const bool around = (shapes_.around >> shape & 1U) != 0;
        const bool inside_only = (block.inside_only >> shape & 1U) != 0;
        LaneBits hits = test_sphere(place, shape, around, inside_only, id);
        if (Policy::kFar && hits != 0) {
          hits = confirmed(place, hits, unsure_of_sphere(place, shape),
                           [&](const Ray& ray) { return is_hit(intersect(CanonicalRay(ray))); });
        }
        changed_ |= note(place, hits);
      }
    }
  }

  /// In units of z: a ray's line is s (u, v, 1). Which side of the surface a ray begins on decides
  /// which of the two roots are within the ray, and is known better than the roots: rays begin at
  /// some distance from surfaces. As the canonical test does, the discriminant is taken from the
  /// line's point nearest the center (Haines et al., Ray Tracing Gems, 2019).
  HWY_INLINE LaneBits test_sphere(std::size_t place, std::size_t shape, bool around,
                                  bool inside_only, scenes::PrimitiveId primitive) {
    const OneShape of{shapes_, shape};
    const Points center{of(SeenShapes::kCenter), of(SeenShapes::kCenter + 1),
                        of(SeenShapes::kCenter + 2)};
    const Floats radius = of(SeenShapes::kRadius);
    const Floats square = hn::Mul(radius, radius);
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    const auto only = [](bool condition) {
      return hn::Gt(all(condition ? 1.0F : 0.0F), hn::Zero(Tag()));
    };
    return for_each_register([&](std::size_t lane) {
      const std::size_t at = block + lane;
      const Points direction{load(&unit_->u[at]), load(&unit_->v[at]), all(1.0F)};
      const Floats per_square = hn::Div(all(1.0F), dot(direction, direction));
      const Floats middle = hn::Mul(dot(direction, center), per_square);
      const auto from_center = [&](Floats s) -> Points {
        return {hn::MulSub(direction.x, s, center.x), hn::MulSub(direction.y, s, center.y),
                hn::Sub(s, center.z)};
      };
      const Points nearest = from_center(middle);
      const Floats left_over = hn::Sub(square, dot(nearest, nearest));
      const Mask meets = hn::Ge(left_over, hn::Zero(Tag()));
      const Floats origin_w = load(kClosest ? &unit_->origin_w[at] : &unit_->w[at]);
      const Floats origin = hn::Div(all(1.0F), origin_w);
      const Points begin = from_center(origin);
      const Mask inside = hn::Lt(dot(begin, begin), square);
      if constexpr (kClosest) {
        const Mask ahead = hn::Or(inside, hn::And(meets, hn::Gt(middle, origin)));
        const Floats half = hn::Sqrt(hn::Mul(hn::Max(left_over, hn::Zero(Tag())), per_square));
        const Mask leaves = hn::Or(inside, only(inside_only));
        const Floats root =
            hn::Max(hn::Add(middle, hn::IfThenElse(leaves, half, hn::Neg(half))), origin);
        const Floats found = hn::Div(all(1.0F), root);
        const Floats w = load(&unit_->w[at]);
        const Mask hit =
            hn::And(hn::And(ahead, hn::Gt(found, w)), lanes_of(unit_->alive[place], lane));
        if (!hn::AllFalse(Tag(), hit)) keep(at, hit, found, w, primitive);
        return hit;
      } else {
        // Toward the apex: what is passed on the way, or left.
        const Mask passes =
            hn::And(meets, hn::And(hn::Lt(middle, origin), hn::Gt(middle, hn::Zero(Tag()))));
        if (around) return inside_only ? only(false) : hn::Not(inside);
        return hn::Or(inside, passes);
      }
    });
  }

  /// `intersect(ray)` returns t or kMiss for a CanonicalRay.
  template <class Intersect>
  std::uint32_t test_by_rays(std::size_t place, scenes::PrimitiveId primitive,
                             Intersect intersect) {
    const std::size_t block = unit_->slot[place];
    LaneBits hits = 0;
    for (LaneBits left = unit_->alive[place]; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const Ray& ray = part_->rays[unit_->ray_at(block * PencilUnit::kBlock + lane)];
      const float t = intersect(CanonicalRay(ray));
      if (!is_hit(t)) continue;
      if constexpr (kClosest) {
        if (!keeps(block * PencilUnit::kBlock + lane, ray, {t, primitive})) continue;
      }
      hits |= LaneBits{1} << lane;
    }
    return note(place, hits);
  }

  /// Closest hits.
  HWY_INLINE void keep(std::size_t at, Mask hit, Floats found, Floats w,
                       scenes::PrimitiveId primitive) {
    const hn::RebindToUnsigned<Tag> ids;
    store(hn::IfThenElse(hit, found, w), &unit_->w[at]);
    hn::Store(hn::IfThenElse(hn::RebindMask(ids, hit), hn::Set(ids, primitive),
                             hn::Load(ids, &unit_->primitive[at])),
              ids, &unit_->primitive[at]);
  }

  /// Notes which rays of a block were hit. Returns the bit of its group if that matters for bounds.
  HWY_INLINE std::uint32_t note(std::size_t place, LaneBits hits) {
    const std::size_t group = place / 16;
    if constexpr (kClosest) {
      const auto found = static_cast<std::uint32_t>(hits != 0);
      changed_blocks_[group] =
          static_cast<std::uint16_t>(changed_blocks_[group] | found << (place % 16));
      return found << group;
    } else {
      const LaneBits alive = unit_->alive[place] & ~hits;
      unit_->alive[place] = static_cast<std::uint16_t>(alive);
      return static_cast<std::uint32_t>(alive == 0) << group;
    }
  }

  /// Of groups in which something changed.
  void update() {
    const std::uint32_t before = unit_->groups_alive;
    bool shrunk = false;
    for (std::uint32_t left = changed_ & before; left != 0; left &= left - 1) {
      const auto group = static_cast<std::size_t>(std::countr_zero(left));
      if constexpr (kClosest) {
        for (LaneBits blocks = changed_blocks_[group]; blocks != 0; blocks &= blocks - 1) {
          find_farthest(group * 16 + static_cast<std::size_t>(std::countr_zero(blocks)));
        }
        changed_blocks_[group] = 0;
      } else {
        LaneBits dead = 0;
        for (std::size_t i = 0; i < 16; ++i) {
          dead |= static_cast<LaneBits>(unit_->alive[group * 16 + i] == 0) << i;
        }
        dead &= unit_->group_blocks[group];
        for (LaneBits some = dead; some != 0; some &= some - 1) {
          unit_->high_u[group * 16 + static_cast<std::size_t>(std::countr_zero(some))] = -kInfinity;
        }
        unit_->group_blocks[group] = static_cast<std::uint16_t>(unit_->group_blocks[group] & ~dead);
        if (unit_->group_blocks[group] == 0) {
          drop_group(group);
          shrunk = true;
          continue;
        }
      }
      bound_group(group);
    }
    if (kClosest || shrunk) bound_all();
  }

  /// The smallest w that is left to beat in a block.
  HWY_INLINE void find_farthest(std::size_t place) {
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    Floats least = all(kInfinity);
    for (std::size_t lane = 0; lane < PencilUnit::kBlock; lane += kLanes) {
      least = hn::Min(least, hn::IfThenElse(lanes_of(unit_->alive[place], lane),
                                            load(&unit_->w[block + lane]), all(kInfinity)));
    }
    unit_->minus_w[place] = -least_of(least);
  }

  /// Sixteen roundings of a depth.
  static constexpr float kDepthRounding = 0x1p-20F;
  /// By how much an edge was moved outward, and as much again on the inside.
  static constexpr float kEdgeRounding = 0x1p-22F;
  /// What bounds of boxes and places may be wrong by: a few roundings of places |u| <= 1.
  static constexpr float kPlacePad = 3e-7F;

  const TileHierarchy* hierarchy_;
  const scenes::Scene* scene_;
  const PencilPart* part_;
  ApexView view_;
  PencilUnit* unit_;
  Counting* counting_;
  PencilBounds all_{};
  std::size_t size_ = 0;
  std::size_t by_shape_count_ = 0;
  std::size_t by_block_count_ = 0;
  std::size_t tests_count_ = 0;
  std::uint32_t changed_ = 0;                                        ///< groups
  std::array<std::uint16_t, PencilUnit::kGroups> changed_blocks_{};  ///< closest hits
  SeenShapes shapes_;
  /// Room for a register behind the last.
  std::array<std::uint32_t, PencilUnit::kGroups * SeenShapes::kMost + 16> by_shape_;
  std::array<std::uint32_t, PencilUnit::kPlaces + 16> by_block_;
  std::array<std::uint32_t, PencilUnit::kPlaces * SeenShapes::kMost + 16> tests_;
  std::array<Entry, kMaxTileDepth*(kTileLanes - 1) + 1> stack_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
