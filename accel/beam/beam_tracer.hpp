#pragma once
// The beam tracer of the thesis.

#include <span>
#include <vector>

#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/beam/beam_samples.hpp"
#include "accel/beam/beam_watch.hpp"
#include "accel/octree/samet.hpp"

namespace beambench {

/// Beams of primary rays through an octree (González López, thesis 1999, chapters 3 and 4): in
/// empty leaves the beams go on, divided by the faces and the leaves behind them; at an occupied
/// leaf the samples of a beam become rays; what leaves the root is background without a ray. Rays
/// that are not of an image, and those that pass an occupied leaf, go one by one with Samet's
/// traversal over the same octree.
class BeamTracer : public Samet {
 public:
  BeamTracer(const Scene& scene, const BeamOptions& options)
      : Samet(scene, options.octree), scene_(&scene), options_(options) {}

  void trace(const PrimaryRays& rays, HitBuffer& buffer) const override {
    NoBeamWatch watch;
    trace_watched(rays, buffer, watch);
  }
  void trace(const PrimaryRays& rays, HitBuffer& buffer, WorkCounters& counters) const override {
    CountingBeamWatch watch(counters);
    trace_watched(rays, buffer, watch);
  }

  std::vector<BeamOutline> beam_outlines(const PrimaryRays& rays) const override {
    OutlineBeamWatch watch(rays.width(), rays.height());
    HitBuffer buffer(rays.width(), rays.height(), rays.samples());
    trace_watched(rays, buffer, watch);
    return std::move(watch).take();
  }

  /// `trace`, told to a policy (see NoBeamWatch).
  template <class Watch>
  void trace_watched(const PrimaryRays& rays, HitBuffer& buffer, Watch& watch) const;

 private:
  template <class Watch>
  class Run;

  const Scene* scene_;
  BeamOptions options_;
};

/// One image being traced.
template <class Watch>
class BeamTracer::Run {
 public:
  Run(const BeamTracer& tracer, const PrimaryRays& rays, HitBuffer& buffer, Watch& watch)
      : tracer_(&tracer),
        view_(tracer.octree().grid(), rays),
        scan_(view_, rays),
        lattices_(sample_lattices(rays, tracer.options_.share_corners)),
        pixels_(static_cast<double>(rays.count())),
        buffer_(&buffer),
        watch_(&watch),
        counting_(watch.rays()) {}

  void operator()() {
    std::fill_n(buffer_->t(), buffer_->size(), kInfinity);
    std::fill_n(buffer_->primitive(), buffer_->size(), kNoPrimitive);
    begin_beams(octree(), view_, queue_);
    while (!queue_.steps.empty()) {
      const BeamStep step = queue_.steps.back();
      queue_.steps.pop_back();
      watch_->met(step.kind, step.beam);
      switch (step.kind) {
        case BeamKind::kLeaving:
          leave(step.beam);
          break;
        case BeamKind::kOccupied:
          test_leaf(step.beam);
          break;
        case BeamKind::kNonTerminal:
          go_on(step.beam);
          break;
      }
    }
    watch_->divided(queue_.clips, queue_.neighbour_searches);
    watch_->finished();
  }

 private:
  const Octree& octree() const { return tracer_->octree(); }

  void leave(const Beam& beam) {
    if constexpr (Watch::kPaintsLeaving) {
      std::uint64_t samples = 0;
      for_each_sample(beam, [&](const SampleLattice& lattice, int x, int y) {
        lattice.for_each_index(*buffer_, x, y, [&](std::size_t index) { watch_->painted(index); });
        ++samples;
      });
      watch_->left(samples);
    }
  }

  void go_on(const Beam& beam) {
    if (beam.crowded()) {
      hand_over(beam, RayReason::kCrowded);
    } else if (tracer_->options_.handover > 0 &&
               area(beam.outline) * pixels_ < static_cast<double>(tracer_->options_.handover)) {
      hand_over(beam, RayReason::kHandover);
    } else {
      continue_beam(octree(), view_, beam, queue_);
    }
  }

  void hand_over(const Beam& beam, RayReason reason) {
    const OctreeCursor place = cursor_at(beam);
    for_each_sample(beam, [&](const SampleLattice& lattice, int x, int y) {
      const Ray ray = scan_.ray(lattice, x, y);
      ClosestHit closest(ray);
      follow(place, ray, CellRay(octree().grid(), ray), closest);
      watch_->handed_over(reason);
      paint(lattice, x, y, closest);
    });
  }

  void test_leaf(const Beam& beam) {
    const OctreeCursor place = cursor_at(beam);
    const auto references = octree().references(place.node());
    std::uint64_t tested = 0;
    for_each_sample(beam, [&](const SampleLattice& lattice, int x, int y) {
      const Ray ray = scan_.ray(lattice, x, y);
      ClosestHit closest(ray);
      for (const PrimitiveId id : references) {
        counting_.add(Counter::kPrimitiveTests);
        closest.test(*tracer_->scene_, id);
      }
      ++tested;
      const CellRay way(octree().grid(), ray);
      if (!(closest.ray.t_max < static_cast<float>(leaf_exit(way, place).t))) {
        watch_->handed_over(RayReason::kOccupied);
        follow(place, ray, way, closest);
      }
      paint(lattice, x, y, closest);
    });
    watch_->tested(tested);
  }

  /// A ray goes on alone behind a leaf (thesis, section 3.6.2).
  void follow(const OctreeCursor& place, const Ray& ray, const CellRay& way, ClosestHit& closest) {
    walk_leaves_behind(place, octree(), tracer_->neighbours(), ray, way, counting_,
                       [&](const OctreeNode& leaf, double exit_t) {
                         return test_references(*tracer_->scene_, octree().references(leaf), exit_t,
                                                counting_, closest);
                       });
  }

  void paint(const SampleLattice& lattice, int x, int y, const ClosestHit& closest) {
    lattice.for_each_index(*buffer_, x, y, [&](std::size_t index) {
      buffer_->set(index, closest.result());
      watch_->painted(index);
    });
  }

  template <class Visit>
  void for_each_sample(const Beam& beam, Visit visit) {
    for (const SampleLattice& lattice : lattices_) {
      scan_.for_each_run(beam, lattice, [&](int y, int first, int last) {
        for (int x = first; x <= last; ++x) visit(lattice, x, y);
      });
    }
  }

  OctreeCursor cursor_at(const Beam& beam) const {
    OctreeCursor cursor(octree());
    cursor.jump(beam.node, beam.corner, beam.size);
    return cursor;
  }

  const BeamTracer* tracer_;
  EyeView view_;
  SampleScan scan_;
  std::vector<SampleLattice> lattices_;
  double pixels_;
  HitBuffer* buffer_;
  Watch* watch_;
  decltype(std::declval<Watch>().rays()) counting_;
  BeamQueue queue_;
};

template <class Watch>
void BeamTracer::trace_watched(const PrimaryRays& rays, HitBuffer& buffer, Watch& watch) const {
  Run<Watch>(*this, rays, buffer, watch)();
}

}  // namespace beambench
