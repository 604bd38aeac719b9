#pragma once
// The leaves of an octree, as cells that beams pass through.

#include <cstdint>
#include <optional>
#include <span>

#include "accel/beam/beam.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/core/cell_search.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::accel::beam {

/// The interface between beams and the leaves of an octree; the cells of other structures have the
/// same functions.
class OctreeCells {
 public:
  /// `tracer` must outlive this object.
  OctreeCells(const octree::Samet& tracer) : tracer_(&tracer) {}  // NOLINT: stands for the tracer

  /// Returns the grid whose planes contain the faces of all cells.
  const CellGrid& grid() const { return octree().grid(); }
  /// Pushes the first beams, through a part of the image (`begin_beams`).
  void begin(const EyeView& view, const ImagePolygon& part, BeamQueue& queue) const {
    begin_beams(octree(), view, part, queue);
  }
  /// Pushes the parts of a beam behind its cell (`continue_beam`).
  void advance(const EyeView& view, const Beam& beam, BeamQueue& queue) const {
    continue_beam(octree(), view, beam, queue);
  }
  /// Returns the references of the beam's cell.
  std::span<const scenes::PrimitiveId> references(const Beam& beam) const {
    return octree().references(octree().nodes()[beam.node]);
  }

  /// Traces a ray behind the beam's cell, which it leaves at t. `watch` may end the trace if
  /// another process takes over.
  template <class Counting, class Watch>
  [[gnu::always_inline]] void follow(const scenes::Scene& scene, const Beam& beam, const Ray& ray,
                                     const CellRay& cell_ray, double t, ClosestHit& best,
                                     Counting& counting, Watch& watch) const {
    octree::OctreeCursor place(octree());
    place.jump(beam.node, beam.corner, beam.size);
    ClosestHit closest = best;  // a copy can stay in registers
    octree::LeafWalk{octree(), tracer_->search(), ray, cell_ray}.behind(
        place, counting, [&](const octree::OctreeNode& leaf, double exit_t) {
          if (watch.leaves_part(leaf, t)) return true;
          t = exit_t;
          return test_references(scene, octree().references(leaf), exit_t, counting, closest);
        });
    best = closest;
  }

  /// Traces a ray from its origin.
  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    return tracer_->find_closest(ray, counting);
  }

 private:
  const octree::Octree& octree() const { return tracer_->octree(); }

  const octree::Samet* tracer_;
};

}  // namespace beambench::accel::beam
