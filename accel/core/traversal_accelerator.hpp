#pragma once
// Derives a structure's whole contract from a single traversal.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/threads.hpp"
#include "accel/core/trace_step.hpp"

namespace beambench::accel {

/// Implements `Accelerator` for a structure that defines each query once, as a template over the
/// policy (`NoCounting`, `WorkCounters` or `StepRecorder`; `NoCounting` describes its calls):
///
///     template <class Counting> std::optional<Hit> find_closest(const Ray&, Counting&) const;
///     template <class Counting> bool find_any(const Ray&, Counting&) const;
///
/// A loop over rays calls these functions directly, without virtual calls in a traversal or between
/// rays.
///
/// The structure is its own inspector and shows the paths of rays; it may override more functions
/// of `Inspector`.
template <class Structure>
class TraversalAccelerator : public Accelerator, public Inspector {
 public:
  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override {
    if (const PrimaryRays* image = rays.image()) return closest_of_image(*image, hits, context);
    if (const RayBatch* batch = rays.batch()) return closest_of_list(batch->rays, hits, context);
    with_counting(context.counters,
                  [&](auto& counting) { hits.set(0, self().find_closest(*rays.ray(), counting)); });
  }
  void any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                const QueryContext& context) const override {
    if (const PrimaryRays* image = rays.image()) return any_of_image(*image, hits, context);
    if (const RayBatch* batch = rays.batch()) return any_of_list(batch->rays, hits, context);
    with_counting(context.counters, [&](auto& counting) {
      hits[0] = self().find_any(*rays.ray(), counting) ? 1 : 0;
    });
  }
  const Inspector* inspector() const override { return this; }

  using Inspector::path;
  std::vector<TraceStep> path(const Ray& ray) const override {
    StepRecorder recorder;
    self().find_closest(ray, recorder);
    return std::move(recorder).take_steps();
  }

 protected:
  // Separate functions, so that inlining into one loop does not depend on the others.
  [[gnu::noinline]] void closest_of_image(const PrimaryRays& image, const HitSpan& hits,
                                          const QueryContext& context) const {
    for_rows(context, image.height(), [&](int begin, int end, auto& counting) {
      image.for_each(begin, end, [&](std::size_t index, const Ray& ray) {
        hits.set(index, self().find_closest(ray, counting));
      });
    });
  }
  [[gnu::noinline]] void closest_of_list(std::span<const Ray> rays, const HitSpan& hits,
                                         const QueryContext& context) const {
    for_rows(context, static_cast<int>(rays.size()), [&](int begin, int end, auto& counting) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        hits.set(i, self().find_closest(rays[i], counting));
      }
    });
  }
  [[gnu::noinline]] void any_of_image(const PrimaryRays& image, std::span<std::uint8_t> hits,
                                      const QueryContext& context) const {
    for_rows(context, image.height(), [&](int begin, int end, auto& counting) {
      image.for_each(begin, end, [&](std::size_t index, const Ray& ray) {
        hits[index] = self().find_any(ray, counting) ? 1 : 0;
      });
    });
  }
  [[gnu::noinline]] void any_of_list(std::span<const Ray> rays, std::span<std::uint8_t> hits,
                                     const QueryContext& context) const {
    for_rows(context, static_cast<int>(rays.size()), [&](int begin, int end, auto& counting) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        hits[i] = self().find_any(rays[i], counting) ? 1 : 0;
      }
    });
  }

 private:
  const Structure& self() const { return static_cast<const Structure&>(*this); }
};

}  // namespace beambench::accel
