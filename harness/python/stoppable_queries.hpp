#pragma once
// Queries that end when their caller has been interrupted, for use between long work and its
// structure.

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "accel/core/forwarding_accelerator.hpp"
#include "accel/core/threads.hpp"
#include "harness/python/interruption.hpp"

namespace beambench::python {

/// Forwards queries to another structure. After a stop request, they throw Stopped: before each ray
/// of an image, and before a batch. If the structure traces beams or packets, its own query for
/// images is used, which is fast but cannot be stopped.
class StoppableQueries : public accel::ForwardingAccelerator {
 public:
  /// The structure must outlive this object.
  StoppableQueries(const accel::Accelerator& structure, StopRequest stop)
      : ForwardingAccelerator(structure),
        stop_(std::move(stop)),
        single_(structure.statistics().image_rays == accel::ImageRays::kSingle) {}

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    stop_.check();
    const accel::PrimaryRays* image = rays.image();
    if (image == nullptr || !single_) {
      return ForwardingAccelerator::closest_hits(rays, hits, context);
    }
    accel::for_rows(context, image->height(),
                    [&]<class Counting>(int begin, int end, Counting& counting) {
                      accel::WorkCounters* counters = nullptr;
                      if constexpr (std::is_same_v<Counting, accel::WorkCounters>)
                        counters = &counting;
                      image->for_each(begin, end, [&](std::size_t index, const accel::Ray& ray) {
                        stop_.check();
                        hits.set(index, structure().closest_hit(ray, counters));
                      });
                    });
  }
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override {
    stop_.check();
    ForwardingAccelerator::any_hits(rays, hits, context);
  }

 private:
  StopRequest stop_;
  bool single_;
};

}  // namespace beambench::python
