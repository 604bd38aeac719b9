#include "accel/core/accelerator.hpp"

#include <mutex>

#include "accel/core/share_rows.hpp"

namespace beambench::accel {
namespace {

template <class FindClosest>
void trace_row_part(const PrimaryRays& rays, int begin, int end, HitBuffer& buffer,
                    FindClosest find_closest) {
  for (int y = begin; y < end; ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        buffer.set(buffer.index(x, y, sample), find_closest(rays.ray(x, y, sample)));
      }
    }
  }
}

}  // namespace

void Accelerator::trace_shared(const PrimaryRays& rays, HitBuffer& buffer) const {
  share_rows(rays.height(), [&](int begin, int end) {
    trace_row_part(rays, begin, end, buffer, [&](const Ray& ray) { return closest_hit(ray); });
  });
}

void Accelerator::trace_shared(const PrimaryRays& rays, HitBuffer& buffer,
                               WorkCounters& counters) const {
  std::mutex adding;
  share_rows(rays.height(), [&](int begin, int end) {
    WorkCounters own;
    trace_row_part(rays, begin, end, buffer, [&](const Ray& ray) { return closest_hit(ray, own); });
    const std::lock_guard lock(adding);
    counters.add(own);
  });
}

}  // namespace beambench::accel
