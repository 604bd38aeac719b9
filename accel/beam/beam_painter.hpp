#pragma once
// From beams to hits: tracing the samples of a beam.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_samples.hpp"
#include "accel/beam/beam_watch.hpp"
#include "accel/beam/leaf_batch.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::accel::beam {

/// For each sample of a buffer 1 if it needs no tracing, where that matters: when some samples are
/// not wanted, or beams continue behind occupied leaves. Empty otherwise.
template <class Sight>
std::vector<std::uint8_t> finished_samples(const BeamOptions& options, const Sight& sight,
                                           const HitBuffer& buffer) {
  std::vector<std::uint8_t> finished = sight.finished();
  if (finished.empty() && !options.continue_with_rays) finished.assign(buffer.size(), 0);
  return finished;
}

/// Finds the samples of beams and traces them (thesis, section 3.6), for one image. It does
/// not depend on other beams, so several painters, in threads or processes, can fill one image.
/// They can share its buffer: two beams have no sample in common, unless one descends from the
/// other.
template <class Watch, class Sight>
class BeamPainter {
 public:
  /// `tracer` holds the octree over the scene. All but `options` must outlive the painter. The
  /// buffer begins as background, `finished` as `finished_samples`.
  BeamPainter(const scenes::Scene& scene, const octree::Samet& tracer, const BeamOptions& options,
              const EyeView& view, const PrimaryRays& rays, const Sight& sight, HitBuffer& buffer,
              std::span<std::uint8_t> finished, Watch& watch)
      : scene_(&scene),
        tracer_(&tracer),
        continue_with_rays_(options.continue_with_rays),
        scan_(view, rays),
        lattices_(sight.lattices(rays, options.share_corners)),
        images_(scene, view, rays),
        sight_(&sight),
        finished_(finished),
        buffer_(&buffer),
        watch_(&watch),
        counting_(watch.rays()) {}

  /// A beam leaves the root: its samples keep the background.
  void leave(const Beam& beam) {
    if constexpr (Watch::kPaintsLeaving || Sight::kRecordsLeaving) {
      std::uint64_t samples = 0;
      for_each_sample(beam, [&](const SampleLattice& lattice, int x, int y) {
        lattice.for_each_index(*buffer_, x, y, [&](std::size_t index) {
          if (!finished_.empty()) finished_[index] = 1;
          watch_->painted(index);
        });
        ++samples;
      });
      watch_->left(samples);
    }
  }

  /// A beam in an empty leaf becomes individual rays.
  void hand_over(const Beam& beam, RayReason reason) {
    const octree::OctreeCursor place = cursor_at(beam);
    for_each_batch(beam, [&] {
      for (LeafBatch::Sample& sample : batch_.samples()) {
        follow(place, CellRay(octree().grid(), sample.ray), sample);
        watch_->handed_over(reason);
        finish(sample);
      }
    });
  }

  /// A beam at an occupied leaf. Returns whether some of its samples continue with it.
  bool test_leaf(const Beam& beam) {
    const octree::OctreeCursor place = cursor_at(beam);
    bool unfinished = false;
    for_each_batch(beam, [&] {
      batch_.test(*scene_, octree().references(place.node()), images_, counting_);
      watch_->tested(batch_.samples().size());
      for (LeafBatch::Sample& sample : batch_.samples()) {
        if (!settle(place, sample)) unfinished = true;
      }
    });
    return unfinished;
  }

 private:
  const octree::Octree& octree() const { return tracer_->octree(); }

  /// After a sample was tested in an occupied leaf: finishes it, or returns false where it
  /// continues with its beam.
  bool settle(const octree::OctreeCursor& place, LeafBatch::Sample& sample) {
    const CellRay cell_ray(octree().grid(), sample.ray);
    const double exit_t = octree::leaf_exit(cell_ray, place).t;
    if (!(sample.closest.ray.t_max < static_cast<float>(exit_t))) {
      if (!continue_with_rays_ || exit_t < sample.ray.t_min) {
        for_each_index(sample,
                       [&](std::size_t index) { buffer_->set(index, sample.closest.result()); });
        return false;
      }
      watch_->handed_over(RayReason::kOccupied);
      follow(place, cell_ray, sample);
    }
    finish(sample);
    return true;
  }

  /// Traces a ray behind a leaf on its own (thesis, section 3.6.2); from where it begins, if it
  /// begins behind that leaf.
  void follow(const octree::OctreeCursor& place, const CellRay& cell_ray,
              LeafBatch::Sample& sample) {
    ClosestHit closest = sample.closest;  // a copy can stay in registers
    double t = octree::leaf_exit(cell_ray, place).t;
    if (t < sample.ray.t_min) {
      if (const auto hit = tracer_->find_closest(sample.ray, counting_)) {
        sample.closest.keep(hit->t, hit->primitive);
      }
      return;
    }
    octree::LeafWalk{octree(), tracer_->neighbors(), sample.ray, cell_ray}.behind(
        place, counting_, [&](const octree::OctreeNode& leaf, double exit_t) {
          if (watch_->leaves_part(leaf, t)) return true;
          t = exit_t;
          return test_references(*scene_, octree().references(leaf), exit_t, counting_, closest);
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

  /// Calls `visit(lattice, x, y)` for the beam's unfinished samples.
  template <class Visit>
  void for_each_sample(const Beam& beam, Visit visit) const {
    for (const SampleLattice& lattice : watch_->chosen(lattices_)) {
      scan_.for_each_run(beam, lattice, [&](int y, int first, int last) {
        for (int x = first; x <= last; ++x) {
          if (finished_.empty() || !is_finished(lattice, x, y)) visit(lattice, x, y);
        }
      });
    }
  }

  /// Fills the batch with the beam's unfinished samples and calls `visit()`, as often as needed for
  /// all of them.
  template <class Visit>
  void for_each_batch(const Beam& beam, Visit visit) {
    batch_.clear();
    for_each_sample(beam, [&](const SampleLattice& lattice, int x, int y) {
      LeafBatch::Sample& sample = batch_.add(lattice, x, y, sight_->ray(scan_, lattice, x, y));
      if (!finished_.empty()) resume(sample);
      if (!batch_.full()) return;
      visit();
      batch_.clear();
    });
    if (!batch_.samples().empty()) visit();
  }

  bool is_finished(const SampleLattice& lattice, int x, int y) const {
    bool finished = true;
    lattice.for_each_index(*buffer_, x, y,
                           [&](std::size_t index) { finished = finished_[index] != 0; });
    return finished;
  }

  /// Restores the hit that a sample found in leaves its beam passed.
  void resume(LeafBatch::Sample& sample) const {
    for_each_index(sample, [&](std::size_t index) {
      if (const auto hit = buffer_->get(index)) sample.closest.keep(hit->t, hit->primitive);
    });
  }

  /// Calls `visit(index)` for a sample's places in the hit buffer.
  template <class Visit>
  void for_each_index(const LeafBatch::Sample& sample, Visit visit) const {
    sample.lattice->for_each_index(*buffer_, sample.x, sample.y, visit);
  }

  octree::OctreeCursor cursor_at(const Beam& beam) const {
    octree::OctreeCursor cursor(octree());
    cursor.jump(beam.node, beam.corner, beam.size);
    return cursor;
  }

  const scenes::Scene* scene_;
  const octree::Samet* tracer_;
  bool continue_with_rays_;
  LeafBatch batch_;
  SampleScan scan_;
  std::vector<SampleLattice> lattices_;
  PrimitiveImages images_;
  const Sight* sight_;
  std::span<std::uint8_t> finished_;
  HitBuffer* buffer_;
  Watch* watch_;
  decltype(std::declval<Watch>().rays()) counting_;
};

}  // namespace beambench::accel::beam
