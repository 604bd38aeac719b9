#pragma once
// The beam tracer of the thesis.

#include <span>
#include <vector>

#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/beam/beam_samples.hpp"
#include "accel/beam/beam_sight.hpp"
#include "accel/beam/beam_watch.hpp"
#include "accel/beam/leaf_batch.hpp"
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
      : BeamTracer(scene, Octree(scene, options.octree), options) {}
  /// Over an octree that was made already.
  BeamTracer(const Scene& scene, Octree octree, const BeamOptions& options)
      : Samet(scene, std::move(octree)), scene_(&scene), options_(options) {}

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

  /// What a mirror shows: `rays` are those of its virtual eye (`PrimaryRays::mirrored`). Samples
  /// that do not see the mirror become misses.
  void trace_behind(const BehindMirror& mirror, const PrimaryRays& rays, HitBuffer& buffer) const;

 private:
  template <class Watch, class Sight>
  class Run;

  const Scene* scene_;
  BeamOptions options_;
};

/// One image being traced.
template <class Watch, class Sight>
class BeamTracer::Run {
 public:
  Run(const BeamTracer& tracer, const PrimaryRays& rays, const Sight& sight, HitBuffer& buffer,
      Watch& watch)
      : tracer_(&tracer),
        view_(tracer.octree().grid(), rays),
        scan_(view_, rays),
        lattices_(sample_lattices(rays, tracer.options_.share_corners)),
        images_(*tracer.scene_, rays),
        sight_(&sight),
        finished_(sight.finished(buffer)),
        samples_(static_cast<double>(rays.count())),
        buffer_(&buffer),
        watch_(&watch),
        counting_(watch.rays()) {
    if (finished_.empty() && !tracer.options_.continue_with_rays) {
      finished_.assign(buffer.size(), 0);
    }
  }

  void operator()() {
    std::fill_n(buffer_->t(), buffer_->size(), kInfinity);
    std::fill_n(buffer_->primitive(), buffer_->size(), kNoPrimitive);
    begin_beams(octree(), view_, sight_->part(view_), queue_);
    BeamStep step;
    while (!queue_.waiting.empty()) {
      queue_.waiting.pop(step);
      watch_->met(step.kind, step.beam);
      switch (step.kind) {
        case BeamKind::kLeaving:
          leave(step.beam);
          break;
        case BeamKind::kOccupied:
          if (sight_->passes(octree().grid(), step.beam)) {
            go_on(step.beam);
          } else {
            test_leaf(step.beam);
          }
          break;
        case BeamKind::kNonTerminal:
          go_on(step.beam);
          break;
      }
    }
    watch_->divided(queue_);
    watch_->finished();
  }

 private:
  const Octree& octree() const { return tracer_->octree(); }

  void leave(const Beam& beam) {
    if constexpr (Watch::kPaintsLeaving) {
      for_each_batch(beam, [&] {
        for (const LeafBatch::Sample& sample : batch_.samples()) {
          for_each_index(sample, [&](std::size_t index) { watch_->painted(index); });
        }
        watch_->left(batch_.samples().size());
      });
    }
  }

  void go_on(const Beam& beam) {
    if (beam.crowded()) {
      hand_over(beam, RayReason::kCrowded);
    } else if (tracer_->options_.handover > 0 &&
               area(beam.outline) * samples_ < static_cast<double>(tracer_->options_.handover)) {
      hand_over(beam, RayReason::kHandover);
    } else {
      continue_beam(octree(), view_, beam, queue_);
    }
  }

  void hand_over(const Beam& beam, RayReason reason) {
    const OctreeCursor place = cursor_at(beam);
    for_each_batch(beam, [&] {
      for (LeafBatch::Sample& sample : batch_.samples()) {
        follow(place, CellRay(octree().grid(), sample.ray), sample);
        watch_->handed_over(reason);
        finish(sample);
      }
    });
  }

  void test_leaf(const Beam& beam) {
    const OctreeCursor place = cursor_at(beam);
    bool unfinished = false;
    for_each_batch(beam, [&] {
      batch_.test(*tracer_->scene_, octree().references(place.node()), images_, counting_);
      watch_->tested(batch_.samples().size());
      for (LeafBatch::Sample& sample : batch_.samples()) {
        if (!settle(place, sample)) unfinished = true;
      }
    });
    if (unfinished) go_on(beam);
  }

  /// What becomes of a sample that was tested in an occupied leaf. Returns false when it goes on
  /// with its beam.
  bool settle(const OctreeCursor& place, LeafBatch::Sample& sample) {
    const CellRay way(octree().grid(), sample.ray);
    if (!(sample.closest.ray.t_max < static_cast<float>(leaf_exit(way, place).t))) {
      if (!tracer_->options_.continue_with_rays) {
        for_each_index(sample,
                       [&](std::size_t index) { buffer_->set(index, sample.closest.result()); });
        return false;
      }
      watch_->handed_over(RayReason::kOccupied);
      follow(place, way, sample);
    }
    finish(sample);
    return true;
  }

  /// A ray goes on alone behind a leaf (thesis, section 3.6.2).
  void follow(const OctreeCursor& place, const CellRay& way, LeafBatch::Sample& sample) {
    ClosestHit closest = sample.closest;  // nobody else's: it can stay in registers
    walk_leaves_behind(place, octree(), tracer_->neighbours(), sample.ray, way, counting_,
                       [&](const OctreeNode& leaf, double exit_t) {
                         return test_references(*tracer_->scene_, octree().references(leaf), exit_t,
                                                counting_, closest);
                       });
    sample.closest = closest;
  }

  void finish(const LeafBatch::Sample& sample) {
    for_each_index(sample, [&](std::size_t index) {
      buffer_->set(index, sample.closest.result());
      if (!finished_.empty()) finished_[index] = 1;
      watch_->painted(index);
    });
  }

  /// Fills the batch with the beam's samples that are not finished and calls `visit()`, until all
  /// were in it.
  template <class Visit>
  void for_each_batch(const Beam& beam, Visit visit) {
    batch_.clear();
    for (const SampleLattice& lattice : watch_->chosen(lattices_)) {
      scan_.for_each_run(beam, lattice, [&](int y, int first, int last) {
        for (int x = first; x <= last; ++x) {
          Ray ray = scan_.ray(lattice, x, y);
          sight_->begin(ray);
          LeafBatch::Sample& sample = batch_.add(lattice, x, y, ray);
          if (!finished_.empty() && !resume(sample)) batch_.drop_last();
          if (!batch_.full()) continue;
          visit();
          batch_.clear();
        }
      });
    }
    if (!batch_.samples().empty()) visit();
  }

  /// Recalls what a sample hit in leaves that its beam passed. Returns false when it is finished.
  bool resume(LeafBatch::Sample& sample) const {
    bool open = false;
    for_each_index(sample, [&](std::size_t index) {
      open = finished_[index] == 0;
      if (const auto hit = buffer_->get(index)) sample.closest.keep(hit->t, hit->primitive);
    });
    return open;
  }

  /// Calls `visit(index)` for a sample's places in the hit buffer.
  template <class Visit>
  void for_each_index(const LeafBatch::Sample& sample, Visit visit) const {
    sample.lattice->for_each_index(*buffer_, sample.x, sample.y, visit);
  }

  OctreeCursor cursor_at(const Beam& beam) const {
    OctreeCursor cursor(octree());
    cursor.jump(beam.node, beam.corner, beam.size);
    return cursor;
  }

  LeafBatch batch_;
  const BeamTracer* tracer_;
  EyeView view_;
  SampleScan scan_;
  std::vector<SampleLattice> lattices_;
  PrimitiveImages images_;
  const Sight* sight_;
  /// Which samples need no more, where that is to be known: if some are not wanted, or beams go on
  /// behind occupied leaves.
  std::vector<std::uint8_t> finished_;
  double samples_;
  HitBuffer* buffer_;
  Watch* watch_;
  decltype(std::declval<Watch>().rays()) counting_;
  BeamQueue queue_;
};

template <class Watch>
void BeamTracer::trace_watched(const PrimaryRays& rays, HitBuffer& buffer, Watch& watch) const {
  Run<Watch, WholeImage>(*this, rays, WholeImage{}, buffer, watch)();
}

inline void BeamTracer::trace_behind(const BehindMirror& mirror, const PrimaryRays& rays,
                                     HitBuffer& buffer) const {
  NoBeamWatch watch;
  Run<NoBeamWatch, BehindMirror>(*this, rays, mirror, buffer, watch)();
}

}  // namespace beambench
