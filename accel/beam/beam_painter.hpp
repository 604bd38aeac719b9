#pragma once
// Turns beams into hits by tracing their samples.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_samples.hpp"
#include "accel/beam/beam_watch.hpp"
#include "accel/beam/leaf_batch.hpp"
#include "accel/beam/octree_cells.hpp"

namespace beambench::accel::beam {

/// Returns a flag for each sample of a buffer, initially 1 if the sample needs no tracing. Empty
/// unless some samples are not wanted or beams continue behind occupied leaves.
template <class Sight>
std::vector<std::uint8_t> finished_samples(const BeamRules& rules, const Sight& sight,
                                           const HitSpan& buffer) {
  std::vector<std::uint8_t> finished = sight.finished();
  if (finished.empty() && !rules.continue_with_rays) finished.assign(buffer.size(), 0);
  return finished;
}

/// Finds the samples of beams and traces them (thesis, section 3.6), for one image. Beams are
/// independent, so several painters, in threads or processes, can fill one image. They can share
/// its buffer: two beams have no samples in common unless one descends from the other. `Cells` is
/// the interface to the cells that beams pass through.
template <class Watch, class Sight, class Cells = OctreeCells>
class BeamPainter {
 public:
  /// `cells` belong to the scene. All arguments except `cells` and `rules` must outlive the
  /// painter. The buffer must initially be background, and `finished` the result of
  /// `finished_samples`.
  BeamPainter(const scenes::Scene& scene, const Cells& cells, const BeamRules& rules,
              const EyeView& view, const PrimaryRays& rays, const Sight& sight,
              const HitSpan& buffer, std::span<std::uint8_t> finished, Watch& watch)
      : scene_(&scene),
        cells_(cells),
        continue_with_rays_(rules.continue_with_rays),
        scan_(view, rays),
        lattices_(sight.lattices(rays, rules.share_corners)),
        images_(images_for(rules.leaf, scene, view, rays)),
        sight_(&sight),
        finished_(finished),
        buffer_(buffer),
        watch_(&watch),
        counting_(watch.rays()) {}

  /// Handles a beam that leaves the root: its samples keep the background.
  void leave(const Beam& beam) {
    if constexpr (Watch::kPaintsLeaving || Sight::kRecordsLeaving) {
      std::uint64_t samples = 0;
      for_each_sample(beam, [&](const SampleLattice& lattice, int x, int y) {
        lattice.for_each_index(buffer_, x, y, [&](std::size_t index) {
          if (!finished_.empty()) finished_[index] = 1;
          watch_->painted(index);
        });
        ++samples;
      });
      watch_->left(samples);
    }
  }

  /// Turns a beam in an empty leaf into individual rays.
  void hand_over(const Beam& beam, RayReason reason) {
    for_each_batch(beam, [&] {
      for (LeafBatch::Sample& sample : batch_.samples()) {
        const CellRay cell_ray(cells_.grid(), sample.ray);
        follow(beam, cell_ray, exit_of(beam, cell_ray), sample);
        watch_->handed_over(reason);
        finish(sample);
      }
    });
  }

  /// Tests a beam at an occupied leaf. Returns whether some of its samples continue with it.
  bool test_leaf(const Beam& beam) {
    bool unfinished = false;
    for_each_batch(beam, [&] {
      if (images_) {
        batch_.test(*scene_, cells_.references(beam), *images_, counting_);
      } else {
        batch_.test(*scene_, cells_.references(beam), counting_);
      }
      watch_->tested(batch_.samples().size());
      for (LeafBatch::Sample& sample : batch_.samples()) {
        if (!settle(beam, sample)) unfinished = true;
      }
    });
    return unfinished;
  }

 private:
  static std::optional<PrimitiveImages> images_for(LeafTest leaf, const scenes::Scene& scene,
                                                   const EyeView& view, const PrimaryRays& rays) {
    const ProbeKernels* kernels = kernels_of(leaf);
    if (kernels == nullptr) return std::nullopt;
    return PrimitiveImages(scene, view, rays, *kernels);
  }

  /// Returns the t at which a ray leaves a beam's cell.
  static double exit_of(const Beam& beam, const CellRay& ray) {
    return std::min({ray.exit_t(0, beam.corner, beam.size), ray.exit_t(1, beam.corner, beam.size),
                     ray.exit_t(2, beam.corner, beam.size)});
  }

  /// Finishes a sample after its test in an occupied leaf, or returns false if it continues with
  /// its beam.
  bool settle(const Beam& beam, LeafBatch::Sample& sample) {
    const CellRay cell_ray(cells_.grid(), sample.ray);
    const double exit_t = exit_of(beam, cell_ray);
    if (!(sample.closest.ray.t_max < static_cast<float>(exit_t))) {
      if (!continue_with_rays_ || exit_t < sample.ray.t_min) {
        for_each_index(sample,
                       [&](std::size_t index) { buffer_.set(index, sample.closest.result()); });
        return false;
      }
      watch_->handed_over(RayReason::kOccupied);
      follow(beam, cell_ray, exit_t, sample);
    }
    finish(sample);
    return true;
  }

  /// Traces a single ray behind a leaf, from `exit_t`, where it leaves the leaf (thesis, section
  /// 3.6.2), or from its origin if that lies behind the leaf.
  void follow(const Beam& beam, const CellRay& cell_ray, double exit_t, LeafBatch::Sample& sample) {
    if (exit_t < sample.ray.t_min) {
      if (const auto hit = cells_.find_closest(sample.ray, counting_)) {
        sample.closest.keep(hit->t, hit->primitive);
      }
      return;
    }
    cells_.follow(*scene_, beam, sample.ray, cell_ray, exit_t, sample.closest, counting_, *watch_);
  }

  void finish(const LeafBatch::Sample& sample) {
    for_each_index(sample, [&](std::size_t index) {
      buffer_.set(index, sample.closest.result());
      if (!finished_.empty()) finished_[index] = 1;
      watch_->painted(index);
    });
  }

  /// Calls `visit(lattice, x, y)` for the beam's unfinished samples.
  template <class Visit>
  void for_each_sample(const Beam& beam, Visit visit) const {
    for (const SampleLattice& lattice : watch_->chosen(lattices_)) {
      const auto ray_at = [&](int x, int y) { return sight_->ray_of(scan_, lattice, x, y); };
      scan_.for_each_run(beam, lattice, ray_at, [&](int y, int first, int last) {
        for (int x = first; x <= last; ++x) {
          if (finished_.empty() || !is_finished(lattice, x, y)) visit(lattice, x, y);
        }
      });
    }
  }

  /// Fills the batch with the beam's unfinished samples and calls `visit()`, repeatedly until all
  /// are processed.
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
    lattice.for_each_index(buffer_, x, y,
                           [&](std::size_t index) { finished = finished_[index] != 0; });
    return finished;
  }

  /// Restores the hit that a sample found in earlier leaves of its beam.
  void resume(LeafBatch::Sample& sample) const {
    for_each_index(sample, [&](std::size_t index) {
      if (const auto hit = buffer_.get(index)) sample.closest.keep(hit->t, hit->primitive);
    });
  }

  /// Calls `visit(index)` for a sample's places in the hit buffer.
  template <class Visit>
  void for_each_index(const LeafBatch::Sample& sample, Visit visit) const {
    sample.lattice->for_each_index(buffer_, sample.x, sample.y, visit);
  }

  const scenes::Scene* scene_;
  Cells cells_;
  bool continue_with_rays_;
  LeafBatch batch_;
  SampleScan scan_;
  std::vector<SampleLattice> lattices_;
  std::optional<PrimitiveImages> images_;
  const Sight* sight_;
  std::span<std::uint8_t> finished_;
  HitSpan buffer_;
  Watch* watch_;
  decltype(std::declval<Watch>().rays()) counting_;
};

}  // namespace beambench::accel::beam
