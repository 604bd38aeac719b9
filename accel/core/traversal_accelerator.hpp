#pragma once
// From one traversal, written once, to the whole contract of a structure.

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/trace_on.hpp"
#include "accel/core/trace_step.hpp"

namespace beambench::accel {

/// Implements `Accelerator` for a structure that writes each query once, as a template over the
/// policy (`NoCounting`, `WorkCounters` or `StepRecorder`; see NoCounting for what it is called
/// with):
///
///     template <class Counting> std::optional<Hit> find_closest(const Ray&, Counting&) const;
///     template <class Counting> bool find_any(const Ray&, Counting&) const;
///
/// A loop over rays calls these directly: no virtual call inside a traversal or between two rays.
template <class Structure>
class TraversalAccelerator : public Accelerator {
 public:
  std::optional<Hit> closest_hit(const Ray& ray, WorkCounters* counters) const override {
    return with_counting(counters,
                         [&](auto& counting) { return self().find_closest(ray, counting); });
  }
  bool any_hit(const Ray& ray, WorkCounters* counters) const override {
    return with_counting(counters, [&](auto& counting) { return self().find_any(ray, counting); });
  }
  void trace(const PrimaryRays& rays, HitBuffer& buffer, WorkCounters* counters) const override {
    with_counting(counters,
                  [&](auto& counting) { trace_rows(rays, 0, rays.height(), buffer, counting); });
  }
  void closest_hits(const RayBatch& batch, HitBuffer& buffer,
                    WorkCounters* counters) const override {
    with_counting(counters, [&](auto& counting) {
      std::size_t index = 0;
      for (const Ray& ray : batch.rays) buffer.set(index++, self().find_closest(ray, counting));
    });
  }
  void any_hits(const RayBatch& batch, std::span<std::uint8_t> hits,
                WorkCounters* counters) const override {
    with_counting(counters, [&](auto& counting) {
      std::size_t index = 0;
      for (const Ray& ray : batch.rays) hits[index++] = self().find_any(ray, counting) ? 1 : 0;
    });
  }
  void trace_shared(const PrimaryRays& rays, HitBuffer& buffer,
                    WorkCounters* counters) const override {
    with_counting(counters, [&]<class Counting>(Counting& counting) {
      std::mutex adding;
      share_rows(rays.height(), [&](int begin, int end) {
        Counting own;
        trace_rows(rays, begin, end, buffer, own);
        const std::lock_guard lock(adding);
        counting.add(own);
      });
    });
  }
  std::vector<TraceStep> explain(const Ray& ray) const override {
    StepRecorder recorder;
    self().find_closest(ray, recorder);
    return std::move(recorder).take_steps();
  }

 private:
  const Structure& self() const { return static_cast<const Structure&>(*this); }

  template <class Counting>
  void trace_rows(const PrimaryRays& rays, int begin, int end, HitBuffer& buffer,
                  Counting& counting) const {
    rays.for_each(begin, end, [&](std::size_t index, const Ray& ray) {
      buffer.set(index, self().find_closest(ray, counting));
    });
  }
};

}  // namespace beambench::accel
