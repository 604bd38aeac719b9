#include "harness/thesis/cluster/split/part_tracer.hpp"

#include <algorithm>

#include "accel/core/cell_search.hpp"
#include "accel/core/intersect.hpp"
#include "accel/octree/leaf_walk.hpp"

namespace beambench::cluster {

accel::octree::OctreeCursor cursor_of_cell(const accel::octree::Octree& octree,
                                           const SceneSplit& split, std::uint32_t cell) {
  const std::int32_t finest = octree.grid().cells.x / split.cells().along();
  return accel::octree::cursor_of(octree, split.cells().cell(cell) * finest, finest);
}

ForeignLeaves::ForeignLeaves(const accel::octree::Octree& octree, const SceneSplit& split,
                             ProcessId self)
    : cells_(octree.nodes().size(), kOwn) {
  for (std::uint32_t cell = 0; cell < split.cells().count(); ++cell) {
    if (!split.is_foreign(cell, self)) continue;
    cells_[cursor_of_cell(octree, split, cell).index()] = cell;
  }
}

std::optional<PartTracer::Place> PartTracer::beginning(const accel::Ray& ray) const {
  const accel::octree::Octree& octree = tracer_->octree();
  const double t = accel::CellRay(octree.grid(), ray).enter(ray.t_min);
  if (!(t < accel::kInfinity)) return std::nullopt;
  return Place{accel::octree::OctreeCursor(octree), t};
}

PartTracer::Place PartTracer::entry(std::uint32_t cell, double t) const {
  return {cursor_of_cell(tracer_->octree(), *split_, cell), t};
}

/// Calls `test(references, exit_t)` for the part's leaves, until it returns true.
template <class Test>
std::optional<PartTracer::Exit> PartTracer::walk(const accel::Ray& ray, const Place& from,
                                                 Test test) const {
  const accel::octree::Octree& octree = tracer_->octree();
  const accel::CellRay planes(octree.grid(), ray);
  const accel::octree::OctreeNode* nodes = octree.nodes().data();
  accel::NoCounting none;
  std::optional<Exit> exit;
  double t = from.t;
  accel::octree::LeafWalk{octree, tracer_->search(), ray, planes}.from(
      from.cursor, from.t, 0, none, [&](const accel::octree::OctreeNode& leaf, double exit_t) {
        if (const auto cell = foreign_->cell_at(static_cast<std::uint32_t>(&leaf - nodes))) {
          exit = Exit{*cell, t};
          return true;
        }
        t = exit_t;
        return test(octree.references(leaf), exit_t);
      });
  return exit;
}

PartTracer::Passage PartTracer::closest(const accel::Ray& ray, const Place& from,
                                        const accel::Hit& best) const {
  accel::ClosestHit here(ray);
  here.ray.t_max = std::min(ray.t_max, best.t);
  accel::NoCounting none;
  const std::optional<Exit> exit = walk(ray, from, [&](const auto& references, double exit_t) {
    return accel::test_references(part_->scene, references, exit_t, none, here);
  });
  const accel::Hit found = global(here.result());
  return {accel::precedes(found, best) ? found : best, exit};
}

PartTracer::Passage PartTracer::any(const accel::Ray& ray, const Place& from) const {
  const accel::CanonicalRay canonical(ray);
  accel::NoCounting none;
  bool is_hit = false;
  const std::optional<Exit> exit = walk(ray, from, [&](const auto& references, double exit_t) {
    is_hit = accel::any_reference_hit(part_->scene, references, canonical, none);
    return is_hit || canonical.t_max < static_cast<float>(exit_t);
  });
  // The primitive and the t of this hit do not matter.
  return {is_hit ? accel::Hit{ray.t_max, 0} : kNoHit, exit};
}

}  // namespace beambench::cluster
