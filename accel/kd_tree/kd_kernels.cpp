#include "accel/kd_tree/kd_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "accel/kd_tree/kd_ray.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/kd_tree/kd_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "accel/bvh/probe_blocks-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::kd_tree::HWY_NAMESPACE {

namespace probes = bvh::HWY_NAMESPACE;

/// Traverses the tree by Havran's recursive algorithm with a stack, TA-B-rec ("Heuristic Ray
/// Shooting Algorithms", dissertation, 2000, appendix C). Of a far child, it stores only the exit:
/// the entry is the exit from the previous cell. Returns the result of `Confirm`.
///
/// A child that the ray meets at only one t, in the plane, is skipped, because any hit at that t is
/// also within the tolerance of the other child.
template <class Confirm, class Counting>
HWY_FLATTEN auto traverse(const KdTree& tree, const scenes::Scene& scene, const Ray& ray,
                          Counting& counting) {
  struct Waiting {
    std::uint32_t node;
    double exit;
  };
  Confirm confirm(scene, ray);
  const KdRay planes(ray);
  KdRay::Interval inside = planes.clip(tree.root, ray.t_min, ray.t_max);
  if (inside.empty()) return confirm.result();
  const bvh::ProbeRay probe_ray(ray, tree.scene_bounds);
  std::array<Waiting, kMaxSplits> waiting;
  std::size_t waiting_count = 0;
  const KdNode* const nodes = tree.nodes.data();
  std::uint32_t at = 0;
  const auto count_step = [&] {
    counting.add(Counter::kTraversalSteps);
    counting.enter([&] {
      const KdPlace place = place_of(tree, at);
      return TraceStep{.place = nodes[at].is_leaf() ? "leaf" : "node",
                       .index = at,
                       .level = place.level,
                       .box = Box{glm::dvec3(place.cell.lower), glm::dvec3(place.cell.upper)},
                       .t_enter = std::max(inside.enter, static_cast<double>(ray.t_min)),
                       .t_exit = inside.exit};
    });
  };
  while (true) {
    count_step();
    KdNode node = nodes[at];
    while (!node.is_leaf()) {
      const std::size_t axis = node.axis();
      const double t = planes.plane_t(axis, node.plane());
      const std::uint32_t first = node.children() | planes.first_child(axis);
      if (t >= inside.exit) {
        at = first;
      } else if (t <= inside.enter) {
        at = first ^ 1U;
      } else {
        waiting[waiting_count++] = {first ^ 1U, inside.exit};
        inside.exit = t;
        at = first;
      }
      count_step();
      node = nodes[at];
    }
    counting.add(Counter::kLeaves);
    counting.add(Counter::kEmptyLeaves, node.block_count() == 0 ? 1 : 0);
    const std::span blocks(tree.blocks.data() + node.first_block(), node.block_count());
    if (probes::test_blocks(blocks, probe_ray, counting, confirm)) break;
    if (waiting_count == 0 || confirm.t_max < static_cast<float>(inside.exit)) break;
    --waiting_count;
    inside.enter = inside.exit;
    at = waiting[waiting_count].node;
    inside.exit = waiting[waiting_count].exit;
  }
  return confirm.result();
}

template <class Counting>
std::optional<Hit> closest(const KdTree& tree, const scenes::Scene& scene, const Ray& ray,
                           Counting& counting) {
  return traverse<probes::ConfirmClosest>(tree, scene, ray, counting);
}

template <class Counting>
bool any(const KdTree& tree, const scenes::Scene& scene, const Ray& ray, Counting& counting) {
  return traverse<probes::ConfirmAny>(tree, scene, ray, counting);
}

template <class Counting>
constexpr KdQueries<Counting> queries() {
  return {closest<Counting>, any<Counting>};
}

const KdKernels& kernels() {
  static constexpr KdKernels kKernels{queries<NoCounting>(), queries<WorkCounters>(),
                                      queries<StepRecorder>(), HWY_TARGET};
  return kKernels;
}

}  // namespace beambench::accel::kd_tree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::accel::kd_tree {

HWY_EXPORT(kernels);

const KdKernels& best_kd_kernels() { return HWY_DYNAMIC_DISPATCH(kernels)(); }

}  // namespace beambench::accel::kd_tree
#endif
