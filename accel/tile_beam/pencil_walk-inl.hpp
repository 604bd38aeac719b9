// Traces through the hierarchy those rays of a part of a pencil that cross one side of the cube
// around the apex.

#if defined(ACCEL_TILE_BEAM_PENCIL_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_WALK_INL
#undef ACCEL_TILE_BEAM_PENCIL_WALK_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_WALK_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "accel/tile_beam/bundle_tests-inl.hpp"
#include "accel/tile_beam/pencil_groups-inl.hpp"
#include "accel/tile_beam/pencil_pairs-inl.hpp"
#include "accel/tile_beam/pencil_shapes-inl.hpp"
#include "accel/tile_beam/pencil_single_rays-inl.hpp"
#include "accel/tile_beam/pencil_tests-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"
#include "accel/tile_beam/prefetch-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// If a part has fewer leaves than this, estimating its number of rays is not worthwhile.
inline constexpr std::uint32_t kFewLeaves = 2;

template <class Policy, class Counting>
class PencilWalk {
 public:
  PencilWalk(const TileHierarchy& hierarchy, const scenes::Scene& scene, const PencilPart& part,
             CubeSide side, PencilUnit& unit, Counting& counting)
      : hierarchy_(&hierarchy),
        view_(view_of(hierarchy, part, side, unit)),
        unit_(&unit),
        counting_(&counting),
        groups_(unit, view_.spread),
        single_rays_(hierarchy, scene, part, view_, unit, groups_, counting),
        pairs_(unit, groups_, shapes_),
        tests_(tests_of(scene, part)) {}
  PencilWalk(const PencilWalk&) = delete;
  PencilWalk& operator=(const PencilWalk&) = delete;

  void operator()() {
    if (groups_.alive() == 0) return;
    // For the whole scene, the estimate is coarse. Only a clearly crowded part is handed over as a
    // whole; examining the children would decide this better, but at a cost.
    const auto half = static_cast<std::uint32_t>(hierarchy_->leaves() / 2);
    stack_[0] = {hierarchy_->root, groups_.alive(),
                 is_crowded(half, groups_.alive(), bounds_of_all()), kEverywhere};
    size_ = 1;
    while (size_ > 0) {
      const Entry entry = stack_[--size_];
      const std::uint32_t groups = entry.groups & groups_.alive();
      if (groups == 0) continue;
      if constexpr (kClosest) {
        if (entry.bounds[kHighW] < groups_.all_bounds().least_w) continue;
      }
      counting_->add(Counter::kTraversalSteps);
      if (entry.crowded) {
        update(single_rays_.hand_over(entry.child, entry.bounds, groups));
      } else if (entry.child.kind() == TileChild::Kind::kNode) {
        push_children(hierarchy_->nodes[entry.child.index()], groups);
      } else {
        visit_leaf(entry, groups);
      }
    }
  }

 private:
  static constexpr bool kClosest = Policy::kClosest;
  /// The maximum distance of a place on a side of the cube from the apex, per unit of depth.
  static constexpr float kDiagonal = 1.75F;

  static constexpr SideBounds kEverywhere{-kAtApex, kAtApex, -kAtApex, kAtApex, -kAtApex, kAtApex};
  struct Entry {
    TileChild child;
    std::uint32_t groups;   ///< groups from which it may be visible, one bit each
    std::uint32_t crowded;  ///< not 0: more leaves than single rays visit (see TileWalk)
    SideBounds bounds;
  };

  static ApexView view_of(const TileHierarchy& hierarchy, const PencilPart& part, CubeSide side,
                          const PencilUnit& unit) {
    const float size = hierarchy.bounds.largest_coordinate();
    if constexpr (!Policy::kHull) {
      return {part.apex, side, size, kClosest ? 0.0F : kDiagonal * unit.end_depth,
              0.0F,      0.0F, false};
    }
    constexpr float kRootOfTwo = 1.4143F;
    const float radius = part.bundle->radius;
    // A triangle found to hide an apex lies at least an eighth of the radius before it, and rays
    // end `surface_lift` before the apex, 2^-18 of the coordinates of apex and origin.
    const glm::vec3 apex = glm::abs(part.apex);
    const float coordinates = std::max({apex.x, apex.y, apex.z}) + 2.0F * part.farthest;
    return {part.apex,
            side,
            size,
            2.0F * radius,
            radius,
            kRootOfTwo * radius / (1.0F - radius / unit.least_depth),
            radius > 0x1p-13F * coordinates};
  }

  auto tests_of(const scenes::Scene& scene, const PencilPart& part) {
    if constexpr (Policy::kHull) {
      return BundleTests(part, *unit_, groups_, shapes_, view_);
    } else {
      return PencilTests<Policy, Counting>(scene, part, *unit_, groups_, single_rays_, shapes_,
                                           view_.scene_size);
    }
  }

  HWY_INLINE void push_children(const TileNode& node, std::uint32_t groups) {
    counting_->add(Counter::kBoxTests, node.count);
    alignas(64) std::array<std::array<float, kTileLanes>, 6> stored;
    LaneBits met = for_each_register([&](std::size_t lane) {
      Mask seen;
      const SeenBounds bounds = bounds_of<Policy>(node.boxes, lane, view_, seen);
      store(bounds.low_u, &stored[kLowU][lane]);
      store(bounds.high_u, &stored[kHighU][lane]);
      store(bounds.low_v, &stored[kLowV][lane]);
      store(bounds.high_v, &stored[kHighV][lane]);
      store(bounds.low_w, &stored[kLowW][lane]);
      store(bounds.high_w, &stored[kHighW][lane]);
      return hn::AndNot(is_negative(apart<Policy>(bounds, groups_.all_bounds(), view_.spread)),
                        seen);
    });
    met &= (LaneBits{1} << node.count) - 1;
    const std::size_t first = size_;
    for (; met != 0; met &= met - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(met));
      const SideBounds bounds{stored[kLowU][lane],  stored[kHighU][lane], stored[kLowV][lane],
                              stored[kHighV][lane], stored[kLowW][lane],  stored[kHighW][lane]};
      const std::uint32_t seen = groups & groups_.groups_in(bounds);
      if (seen == 0) continue;
      prefetch_child(*hierarchy_, node.children[lane]);
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

  /// Returns the bounds of the whole hierarchy.
  SideBounds bounds_of_all() const {
    TileBoxes boxes{};
    boxes.set(0, hierarchy_->bounds);
    Mask seen;
    const SeenBounds bounds = bounds_of<Policy>(boxes, 0, view_, seen);
    return {hn::GetLane(bounds.low_u),  hn::GetLane(bounds.high_u), hn::GetLane(bounds.low_v),
            hn::GetLane(bounds.high_v), hn::GetLane(bounds.low_w),  hn::GetLane(bounds.high_w)};
  }

  /// Returns whether a part of the hierarchy has more leaves than `kHandoverLeaves` for each ray
  /// that may meet it. If so, single rays traverse it, which visit a few leaves each. The number of
  /// rays is estimated from the density of the groups' rays over the part's whole bounds, because
  /// most leaves of a large part may lie outside the groups.
  HWY_INLINE bool is_crowded(std::uint32_t leaves, std::uint32_t groups,
                             const SideBounds& bounds) const {
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

  HWY_INLINE void visit_leaf(const Entry& entry, std::uint32_t groups) {
    counting_->add(Counter::kLeaves);
    switch (entry.child.kind()) {
      case TileChild::Kind::kMeshlet: {
        const Meshlet& meshlet = hierarchy_->meshlets[entry.child.index()];
        TriangleShapes<Policy>(meshlet, view_, shapes_)(groups_.all_bounds());
        if (shapes_.present == 0) return;
        pairs_.template find<true>(entry.bounds, groups, meshlet.triangle_count);
        count_tests(scenes::PrimitiveKind::kPolygon);
        return update(tests_.test_triangles(pairs_.found(), meshlet));
      }
      case TileChild::Kind::kSpheres: {
        const SphereBlock& block = hierarchy_->spheres[entry.child.index()];
        set_up_spheres<Policy>(block, view_, 0x1p-20F * view_.scene_size, shapes_);
        if (shapes_.present == 0) return;
        pairs_.template find<false>(entry.bounds, groups, block.count);
        count_tests(scenes::PrimitiveKind::kSphere);
        return update(tests_.test_spheres(pairs_.found(), block));
      }
      case TileChild::Kind::kCones: {
        const ConeBlock& block = hierarchy_->cones[entry.child.index()];
        set_up_cones<Policy>(block, view_, shapes_);
        if (shapes_.present == 0) return;
        pairs_.template find<false>(entry.bounds, groups, block.count);
        count_tests(scenes::PrimitiveKind::kCone);
        return update(tests_.test_cones(pairs_.found(), block));
      }
      case TileChild::Kind::kNode:
        return;
    }
  }

  void count_tests(scenes::PrimitiveKind kind) {
    counting_->add_tests(kind, pairs_.found().size() * PencilUnit::kBlock);
  }

  HWY_INLINE void update(std::uint32_t changed_groups) {
    if (changed_groups != 0) groups_.update(changed_groups);
  }

  const TileHierarchy* hierarchy_;
  ApexView view_;
  PencilUnit* unit_;
  Counting* counting_;
  PencilGroups<Policy> groups_;
  SeenShapes shapes_;
  PencilSingleRays<Policy, Counting> single_rays_;
  PencilPairs<Policy> pairs_;
  std::conditional_t<Policy::kHull, BundleTests, PencilTests<Policy, Counting>> tests_;
  std::size_t size_ = 0;
  std::array<Entry, kMaxTileDepth*(kTileLanes - 1) + 1> stack_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
