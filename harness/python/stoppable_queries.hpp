#pragma once
// What stands between long work and its structure: queries that end when the work is to stop.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "accel/core/accelerator.hpp"
#include "harness/python/interruption.hpp"

namespace beambench::python {

/// The hits and counters of another structure. Its queries throw Stopped after a request: before
/// each ray of an image, and before a batch. Where the structure traces beams or packets, its own
/// query for images is used, which is fast and cannot be stopped.
class StoppableQueries : public accel::Accelerator {
 public:
  /// The structure must outlive this.
  StoppableQueries(const accel::Accelerator& structure, StopRequest stop)
      : structure_(&structure),
        stop_(std::move(stop)),
        single_(structure.statistics().image_rays == accel::ImageRays::kSingle) {}

  std::optional<accel::Hit> closest_hit(const accel::Ray& ray,
                                        accel::WorkCounters* counters) const override {
    stop_.check();
    return structure_->closest_hit(ray, counters);
  }
  bool any_hit(const accel::Ray& ray, accel::WorkCounters* counters) const override {
    stop_.check();
    return structure_->any_hit(ray, counters);
  }
  void trace(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
             accel::WorkCounters* counters) const override {
    if (!single_) return structure_->trace(rays, buffer, counters);
    rays.for_each(0, rays.height(), [&](std::size_t index, const accel::Ray& ray) {
      buffer.set(index, closest_hit(ray, counters));
    });
  }
  void trace_shared(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
                    accel::WorkCounters* counters) const override {
    if (!single_) return structure_->trace_shared(rays, buffer, counters);
    Accelerator::trace_shared(rays, buffer, counters);  // row by row, by closest_hit
  }
  void closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                    accel::WorkCounters* counters) const override {
    stop_.check();
    structure_->closest_hits(batch, buffer, counters);
  }
  void any_hits(const accel::RayBatch& batch, std::span<std::uint8_t> hits,
                accel::WorkCounters* counters) const override {
    stop_.check();
    structure_->any_hits(batch, hits, counters);
  }
  accel::Statistics statistics() const override { return structure_->statistics(); }

 private:
  const accel::Accelerator* structure_;
  StopRequest stop_;
  bool single_;
};

}  // namespace beambench::python
