#pragma once
// Ray classification (Arvo and Kirk 1987).

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "accel/core/canonical_ray.hpp"
#include "accel/core/cell_search.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/slab_ray.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/ray_classification/ray_tree.hpp"

namespace beambench::accel::ray_classification {

/// Subdivides the set of rays instead of space ("Fast Ray Tracing by Ray Classification", Computer
/// Graphics 21(4), 1987): a ray is a point in five dimensions, which are its origin and two slopes
/// on a face of the direction cube. Sets of rays are boxes of such points; each has a list of the
/// primitives that its rays may meet, in order along the face's axis. A ray finds its set by
/// comparing its coordinates with planes, without stepping through space, and is tested against the
/// list from the near end until the closest hit lies before all remaining primitives.
///
/// Rays that begin outside the scene's box are moved to where they enter it.
class RayClassification : public TraversalAccelerator<RayClassification> {
 public:
  static std::vector<ParameterInfo> parameters();
  static RayTreeOptions options_from(const Parameters& parameters);

  RayClassification(const scenes::Scene& scene, const RayTreeOptions& options);

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    ClosestHit closest(ray);
    for_each_candidate(ray, closest.ray, counting, [&](scenes::PrimitiveId id) {
      counting.tested(id, closest.test(*scene_, id));
      return false;
    });
    return closest.result();
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    bool found = false;
    for_each_candidate(ray, canonical, counting, [&](scenes::PrimitiveId id) {
      found = is_hit(intersect(canonical, *scene_, id));
      return found;
    });
    return found;
  }

  Statistics statistics() const override;
  /// Returns the boxes of origins of all ray sets that have candidates.
  std::vector<Cell> occupied_cells() const override;

 private:
  /// Calls `test(id)` for the primitives that the ray may meet before `canonical.t_max`, until
  /// `test` returns true. `canonical` is the ray; its t_max may shrink.
  template <class Counting, class Test>
  void for_each_candidate(const Ray& ray, const CanonicalRay& canonical, Counting& counting,
                          const Test& test) const {
    if (boxes_.empty()) return;
    const SlabRay slabs(ray);
    const BoxInterval inside = slabs.interval(bounds_, ray.t_min, canonical.t_max);
    counting.add(Counter::kBoxTests);
    if (inside.empty()) return;
    const RayTree& tree = *trees_[face_of(canonical)];
    const Point point = point_of(canonical, tree.face());
    const RayTree::Place place = tree.find(point, [&](const RayTree::Place& at, bool is_leaf) {
      counting.add(Counter::kTraversalSteps);
      counting.enter([&] { return step_of(tree, at, is_leaf, inside); });
    });
    counting.add(Counter::kLeaves);
    counting.add(Counter::kEmptyLeaves, place.set->candidates.empty() ? 1 : 0);
    const auto axis = static_cast<int>(tree.face().along);
    const bool forward = tree.face().sign > 0.0;
    const double origin = canonical.origin[axis];
    const double inverse = 1.0 / canonical.direction[axis];
    for (const scenes::PrimitiveId id : place.set->candidates) {
      // Candidates are sorted: all later ones begin at this t or beyond, rounded like a hit's t.
      const float near = forward ? boxes_[id].lower[axis] : boxes_[id].upper[axis];
      if (static_cast<float>((near - origin) * inverse) > canonical.t_max) break;
      counting.add(Counter::kBoxTests);
      if (slabs.interval(boxes_[id], ray.t_min, canonical.t_max).empty()) continue;
      counting.add_tests(scene_->primitives[id].kind);
      if (test(id)) return;
    }
  }

  static std::size_t face_of(const CanonicalRay& ray) {
    const auto axis = static_cast<std::size_t>(ray.main_axis);
    return 2 * axis + (ray.direction[ray.main_axis] < 0.0 ? 1 : 0);
  }
  Point point_of(const CanonicalRay& ray, const Face& face) const;
  static TraceStep step_of(const RayTree& tree, const RayTree::Place& place, bool is_leaf,
                           const BoxInterval& inside);

  const scenes::Scene* scene_;
  std::vector<scenes::Bounds> boxes_;                       ///< widened boxes of the primitives
  scenes::Bounds bounds_;                                   ///< box of all these boxes
  std::unique_ptr<std::atomic<std::uint64_t>> references_;  ///< total in the lists of all trees
  std::array<std::unique_ptr<RayTree>, kFaces> trees_;
};

}  // namespace beambench::accel::ray_classification
