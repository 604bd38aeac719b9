#pragma once
// A list of objects that are kept outside an octree.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "accel/core/intersect.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/statistics.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/octree/choose_octree.hpp"
#include "accel/octree/octree.hpp"
#include "scenes/scene.hpp"
#include "scenes/subset.hpp"

namespace beambench::accel::octree {

/// The primitives of a scene inside and outside an octree.
struct InsideAndOutside {
  /// `largest`: objects above this size, relative to the scene's, stay outside.
  InsideAndOutside(const scenes::Scene& scene, double largest) {
    const double limit = largest * glm::length(glm::dvec3(scene.bounds.extent()));
    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
      const double size = glm::length(glm::dvec3(primitive_bounds(scene, id).extent()));
      (size > limit ? outside : inside).push_back(id);
    }
  }

  std::vector<scenes::PrimitiveId> inside;
  std::vector<scenes::PrimitiveId> outside;
};

/// Forwards the counted work of a structure over part of a scene, with primitives numbered as in
/// the whole scene.
template <class Counting>
class Renumbered {
 public:
  Renumbered(Counting& counting, std::span<const scenes::PrimitiveId> ids)
      : counting_(counting), ids_(ids) {}

  void add(Counter counter, std::uint64_t amount = 1) { counting_.add(counter, amount); }
  void add(std::string_view name, std::uint64_t amount = 1) { counting_.add(name, amount); }
  void add_tests(scenes::PrimitiveKind kind, std::uint64_t amount = 1) {
    counting_.add_tests(kind, amount);
  }
  template <class Make>
  void enter(const Make& make) {
    counting_.enter(make);
  }
  void tested(scenes::PrimitiveId id, float t) { counting_.tested(ids_[id], t); }

 private:
  Counting& counting_;
  std::span<const scenes::PrimitiveId> ids_;
};

/// A structure over an octree whose largest objects stay in a list (thesis, section 4.4: the world
/// keeps objects outside all cubes, such as infinite planes, in a separate list). Each ray is
/// tested against all of them first. A large floor then no longer enlarges the root, so the same
/// levels divide the other objects more finely.
template <class Inner>
class WithOutsideList : public TraversalAccelerator<WithOutsideList<Inner>> {
 public:
  /// `largest`: see `InsideAndOutside`.
  WithOutsideList(const scenes::Scene& scene, const OctreeOptions& options, double largest,
                  const Workload& workload)
      : scene_(&scene),
        ids_(scene, largest),
        rest_(std::make_unique<const scenes::Scene>(scenes::subset(scene, ids_.inside))),
        inner_(*rest_,
               choose_octree(*rest_, for_a_part_of(scene, options), workload, samet_trace_cost)) {}

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    ClosestHit closest(ray);
    for (const scenes::PrimitiveId id : ids_.outside) {
      counting.add_tests(scene_->primitives[id].kind);
      counting.tested(id, closest.test(*scene_, id));
    }
    Ray rest = ray;
    rest.t_max = closest.ray.t_max;
    Renumbered<Counting> renumbered(counting, ids_.inside);
    if (const std::optional<Hit> hit = inner_.find_closest(rest, renumbered)) {
      closest.keep(hit->t, ids_.inside[hit->primitive]);
    }
    return closest.result();
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    for (const scenes::PrimitiveId id : ids_.outside) {
      counting.add_tests(scene_->primitives[id].kind);
      if (is_hit(intersect(canonical, *scene_, id))) return true;
    }
    Renumbered<Counting> renumbered(counting, ids_.inside);
    return inner_.find_any(ray, renumbered);
  }

  Statistics statistics() const override {
    Statistics statistics = inner_.statistics();
    statistics.bytes +=
        scenes::memory_bytes(*rest_) + ids_.inside.capacity() * sizeof(scenes::PrimitiveId);
    statistics.more.emplace_back("outside_objects", static_cast<double>(ids_.outside.size()));
    return statistics;
  }
  std::vector<Cell> occupied_cells() const override { return inner_.occupied_cells(); }
  const Inner& inner() const { return inner_; }

 private:
  /// Adapts the options to a part of the scene: the eye may be as far away as the whole scene's
  /// size allows (`overlap_tolerance`).
  static OctreeOptions for_a_part_of(const scenes::Scene& scene, OctreeOptions options) {
    options.least_tolerance = overlap_tolerance(scene);
    return options;
  }

  const scenes::Scene* scene_;
  InsideAndOutside ids_;
  std::unique_ptr<const scenes::Scene> rest_;  ///< the scene without the outside objects
  Inner inner_;
};

}  // namespace beambench::accel::octree
