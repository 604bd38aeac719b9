#pragma once
// The beam tracer of the thesis.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/beam/beam_sight.hpp"
#include "accel/beam/beam_watch.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::accel::beam {

/// Beams of primary rays through an octree (González López, thesis 1999, chapters 3 and 4): in
/// empty leaves the beams continue, divided by the faces and the leaves behind them; at an occupied
/// leaf the samples of a beam become rays; what leaves the root is background without a ray. Rays
/// that are not of an image, direct or seen in a planar mirror, and those that pass an occupied
/// leaf, are traced one by one by Samet's traversal of the same octree.
class BeamTracer : public octree::Samet {
 public:
  BeamTracer(const scenes::Scene& scene, const BeamOptions& options)
      : BeamTracer(scene, octree::Octree(scene, options.octree), options) {}
  /// Over an octree that was made already.
  BeamTracer(const scenes::Scene& scene, octree::Octree octree, const BeamOptions& options)
      : octree::Samet(scene, std::move(octree)), scene_(&scene), options_(options) {}

  const scenes::Scene& scene() const { return *scene_; }
  const BeamOptions& options() const { return options_; }

  void trace(const PrimaryRays& rays, HitBuffer& buffer, WorkCounters* counters) const override {
    if (counters != nullptr) {
      CountingBeamWatch watch(*counters);
      return trace_watched(rays, buffer, watch);
    }
    NoBeamWatch watch;
    trace_watched(rays, buffer, watch);
  }

  /// What planar mirrors show is traced in beams from their virtual eyes (`BehindMirror`), all
  /// other rays one by one.
  void closest_hits(const RayBatch& batch, HitBuffer& buffer,
                    WorkCounters* counters) const override;

  /// The beams are shared among the threads: two have no sample in common, unless one descends from
  /// the other.
  void trace_shared(const PrimaryRays& rays, HitBuffer& buffer,
                    WorkCounters* counters) const override;

  /// Samples become rays at occupied leaves only, so that not all of an image's rays are made.
  Statistics statistics() const override {
    Statistics statistics = octree::Samet::statistics();
    statistics.image_rays = ImageRays::kOwn;
    return statistics;
  }

  std::vector<BeamOutline> beam_outlines(const PrimaryRays& rays) const override {
    OutlineBeamWatch watch(rays.width(), rays.height());
    HitBuffer buffer(rays.width(), rays.height(), rays.samples());
    trace_watched(rays, buffer, watch);
    return std::move(watch).take();
  }

  /// `trace`, reported to a policy (see NoBeamWatch).
  template <class Watch>
  void trace_watched(const PrimaryRays& rays, HitBuffer& buffer, Watch& watch) const;

 private:
  template <class Watch, class Sight>
  class Run;
  template <class Watch>
  class SharedRun;

  template <class Counting>
  void trace_mirror(const RayBatch& batch, const Pencil& pencil, HitBuffer& buffer,
                    Counting& counting) const;

  const scenes::Scene* scene_;
  BeamOptions options_;
};

/// One image being traced, or one thread's share of it.
template <class Watch, class Sight>
class BeamTracer::Run {
 public:
  Run(const BeamTracer& tracer, const PrimaryRays& rays, const Sight& sight, HitBuffer& buffer,
      std::span<std::uint8_t> finished, Watch& watch)
      : tracer_(&tracer),
        view_(sight.view(tracer.octree().grid(), rays)),
        sight_(&sight),
        painter_(*tracer.scene_, tracer, tracer.options_, view_, rays, sight, buffer, finished,
                 watch),
        samples_(static_cast<double>(rays.count())),
        handover_(sight.handover(tracer.options_)),
        buffer_(&buffer),
        watch_(&watch) {
    queue_.passed = sight.passed();
  }

  /// The whole image.
  void operator()() {
    begin();
    work([](BeamStack&) {});
    end();
  }

  /// Makes all samples background and queues the first beams.
  void begin() {
    std::fill_n(buffer_->t(), buffer_->size(), kInfinity);
    std::fill_n(buffer_->primitive(), buffer_->size(), scenes::kNoPrimitive);
    begin_beams(octree(), view_, sight_->part(view_), queue_);
  }

  BeamStack& waiting() { return queue_.waiting; }

  /// Traces beams until none waits. Before each, `share(waiting)` may remove some.
  template <class Share>
  void work(Share share) {
    BeamStep step;
    while (!queue_.waiting.empty()) {
      share(queue_.waiting);
      queue_.waiting.pop(step);
      watch_->met(step.kind, step.beam);
      switch (step.kind) {
        case BeamKind::kLeaving:
          painter_.leave(step.beam);
          break;
        case BeamKind::kOccupied:
          if (painter_.test_leaf(step.beam)) continue_with(step.beam);
          break;
        case BeamKind::kNonTerminal:
          continue_with(step.beam);
          break;
      }
    }
    watch_->resting();
  }

  void end() {
    watch_->divided(queue_);
    watch_->finished();
  }

 private:
  const octree::Octree& octree() const { return tracer_->octree(); }

  void continue_with(const Beam& beam) {
    if (beam.crowded()) {
      painter_.hand_over(beam, RayReason::kCrowded);
    } else if (handover_ > 0 && area(beam.outline) * samples_ < static_cast<double>(handover_)) {
      painter_.hand_over(beam, RayReason::kHandover);
    } else {
      continue_beam(octree(), view_, beam, queue_);
    }
  }

  const BeamTracer* tracer_;
  EyeView view_;
  const Sight* sight_;
  BeamPainter<Watch, Sight> painter_;
  double samples_;
  std::int64_t handover_;
  HitBuffer* buffer_;
  Watch* watch_;
  BeamQueue queue_;
};

template <class Watch>
void BeamTracer::trace_watched(const PrimaryRays& rays, HitBuffer& buffer, Watch& watch) const {
  const WholeImage sight;
  auto finished = finished_samples(options_, sight, buffer);
  Run<Watch, WholeImage>(*this, rays, sight, buffer, finished, watch)();
}

}  // namespace beambench::accel::beam
