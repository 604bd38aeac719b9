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
#include "accel/core/share_rows.hpp"
#include "accel/core/step_recorder.hpp"

namespace beambench::accel {

/// Implements `Accelerator` for a structure that writes each query once, as a template over the
/// policy (`NoCounting`, `WorkCounters` or `StepRecorder`; see NoCounting for what it is told):
///
///     template <class Counting> std::optional<Hit> find_closest(const Ray&, Counting&) const;
///     template <class Counting> bool find_any(const Ray&, Counting&) const;
///
/// A loop over rays calls these directly: no virtual call inside a traversal or between two rays.
template <class Structure>
class TraversalAccelerator : public Accelerator {
 public:
  std::optional<Hit> closest_hit(const Ray& ray) const override {
    NoCounting none;
    return self().find_closest(ray, none);
  }
  bool any_hit(const Ray& ray) const override {
    NoCounting none;
    return self().find_any(ray, none);
  }
  void trace(const PrimaryRays& rays, HitBuffer& buffer) const override {
    NoCounting none;
    trace_rows(rays, 0, rays.height(), buffer, none);
  }
  void closest_hits(std::span<const Ray> rays, HitBuffer& buffer) const override {
    NoCounting none;
    find_each_closest(rays, buffer, none);
  }
  void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> answers) const override {
    NoCounting none;
    find_each_any(rays, answers, none);
  }

  std::optional<Hit> closest_hit(const Ray& ray, WorkCounters& counters) const override {
    return self().find_closest(ray, counters);
  }
  bool any_hit(const Ray& ray, WorkCounters& counters) const override {
    return self().find_any(ray, counters);
  }
  void trace(const PrimaryRays& rays, HitBuffer& buffer, WorkCounters& counters) const override {
    trace_rows(rays, 0, rays.height(), buffer, counters);
  }
  void closest_hits(std::span<const Ray> rays, HitBuffer& buffer,
                    WorkCounters& counters) const override {
    find_each_closest(rays, buffer, counters);
  }
  void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> answers,
                WorkCounters& counters) const override {
    find_each_any(rays, answers, counters);
  }

  void trace_shared(const PrimaryRays& rays, HitBuffer& buffer) const override {
    NoCounting none;
    trace_rows_shared(rays, buffer, none);
  }
  void trace_shared(const PrimaryRays& rays, HitBuffer& buffer,
                    WorkCounters& counters) const override {
    trace_rows_shared(rays, buffer, counters);
  }

  std::vector<TraceStep> explain(const Ray& ray) const override {
    StepRecorder recorder;
    self().find_closest(ray, recorder);
    return std::move(recorder).take_steps();
  }

 private:
  const Structure& self() const { return static_cast<const Structure&>(*this); }

  template <class Counting>
  void find_each_closest(std::span<const Ray> rays, HitBuffer& buffer, Counting& counting) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      buffer.set(i, self().find_closest(rays[i], counting));
    }
  }

  template <class Counting>
  void find_each_any(std::span<const Ray> rays, std::span<std::uint8_t> answers,
                     Counting& counting) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      answers[i] = self().find_any(rays[i], counting) ? 1 : 0;
    }
  }

  template <class Counting>
  void trace_rows(const PrimaryRays& rays, int begin, int end, HitBuffer& buffer,
                  Counting& counting) const {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < rays.width(); ++x) {
        for (int sample = 0; sample < rays.samples(); ++sample) {
          buffer.set(buffer.index(x, y, sample),
                     self().find_closest(rays.ray(x, y, sample), counting));
        }
      }
    }
  }

  template <class Counting>
  void trace_rows_shared(const PrimaryRays& rays, HitBuffer& buffer, Counting& counting) const {
    std::mutex adding;
    share_rows(rays.height(), [&](int begin, int end) {
      Counting own;
      trace_rows(rays, begin, end, buffer, own);
      const std::lock_guard lock(adding);
      counting.add(own);
    });
  }
};

}  // namespace beambench::accel
