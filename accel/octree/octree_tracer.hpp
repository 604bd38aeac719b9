#pragma once
// Combines an octree and a search for the leaves along a ray into a structure for single rays.

#include <concepts>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "accel/core/cell_search.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/statistics.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::octree {

/// The octree of the thesis (section 3.3) for individual rays. `Search`, made from the octree,
/// finds the leaves along a ray by `walk_leaves(octree, search, ray, counting, visit)`; all
/// searches return the same leaves, order and hits.
template <class Search>
class OctreeTracer : public TraversalAccelerator<OctreeTracer<Search>> {
 public:
  using Tree = typename Search::Cursor::Tree;

  OctreeTracer(const scenes::Scene& scene, const OctreeOptions& options)
      : scene_(&scene), octree_(scene, options), search_(octree_) {
    require_fitting_planes();
  }
  OctreeTracer(const scenes::Scene& scene, Tree octree) requires std::move_constructible<Tree>
      : scene_(&scene), octree_(std::move(octree)), search_(octree_) {
    require_fitting_planes();
  }

  const Tree& octree() const { return octree_; }
  /// Returns the search for the leaves along a ray.
  const Search& search() const { return search_; }

  Statistics statistics() const override {
    Statistics statistics = octree_.statistics();
    search_.describe(statistics);
    return statistics;
  }

  std::vector<Cell> occupied_cells() const override { return octree_.occupied_cells(); }

  /// Returns the nodes, for searches that identify leaves by node numbers.
  std::vector<NodeFacts> nodes() const override {
    std::vector<NodeFacts> facts;
    if constexpr (requires { requires Search::kNeighborSteps; }) {
      for (const OctreeNode& node : octree_.nodes()) {
        facts.push_back({facts.empty() ? 0 : node.parent, node.is_leaf(), node.count});
      }
    }
    return facts;
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    ClosestHit closest(ray);
    walk_leaves(octree_, search_, ray, counting, [&](const auto& leaf, double exit_t) {
      return test_references(*scene_, octree_.references(leaf), exit_t, counting, closest);
    });
    return closest.result();
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    bool found = false;
    walk_leaves(octree_, search_, ray, counting, [&](const auto& leaf, double exit_t) {
      found = any_reference_hit(*scene_, octree_.references(leaf), canonical, counting);
      return found || canonical.t_max < static_cast<float>(exit_t);
    });
    return found;
  }

 private:
  /// Throws an InputError if planes are arbitrary but the search requires halved nodes.
  void require_fitting_planes() const {
    if constexpr (std::is_same_v<typename Search::Cursor, OctreeCursor>) {
      if (octree_.has_central_planes()) return;
      throw InputError(
          "planes=cost needs a traversal from the root down, as in glassner and gargantini; "
          "choose one of these, or planes=median");
    }
  }

  const scenes::Scene* scene_;
  Tree octree_;
  Search search_;
};

}  // namespace beambench::accel::octree
