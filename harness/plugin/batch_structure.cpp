#include "harness/plugin/batch_structure.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "accel/core/threads.hpp"

namespace beambench::plugin {
namespace {

using accel::Ray;

/// The approximate number of rays of an image in one batch: so many that the cost of a call is
/// negligible, but few enough for the first-level cache.
constexpr std::size_t kImageBatch = 512;

static_assert(sizeof(Ray) == sizeof(beambench_ray) &&
              offsetof(Ray, t_min) == offsetof(beambench_ray, t_min) &&
              offsetof(Ray, direction) == offsetof(beambench_ray, direction) &&
              offsetof(Ray, t_max) == offsetof(beambench_ray, t_max));

beambench_batch batch_of(std::span<const Ray> rays, std::size_t row) {
  return {sizeof(beambench_batch), rays.size(), reinterpret_cast<const beambench_ray*>(rays.data()),
          row};
}

class BatchStructure final : public accel::Accelerator {
 public:
  explicit BatchStructure(std::unique_ptr<BatchTracer> tracer) : tracer_(std::move(tracer)) {}

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    for_each_batch(rays, context, [&](std::size_t first, const beambench_batch& batch) {
      tracer_->closest_hits(batch, hits.t() + first, hits.primitive() + first);
    });
  }
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override {
    for_each_batch(rays, context, [&](std::size_t first, const beambench_batch& batch) {
      tracer_->any_hits(batch, hits.data() + first);
    });
  }
  accel::Statistics statistics() const override { return tracer_->statistics(); }

 private:
  template <class Trace>
  void for_each_batch(const accel::RaySource& rays, accel::QueryContext context,
                      const Trace& trace) const {
    if (tracer_->takes_whole_queries()) context.threads = 1;
    if (const accel::PrimaryRays* image = rays.image()) return trace_image(*image, context, trace);
    const std::span<const Ray> list =
        rays.batch() != nullptr ? rays.batch()->rays : std::span(rays.ray(), 1);
    accel::for_rows(context, static_cast<int>(list.size()), [&](int begin, int end, auto&) {
      const auto first = static_cast<std::size_t>(begin);
      trace(first, batch_of(list.subspan(first, static_cast<std::size_t>(end - begin)), 0));
    });
  }

  template <class Trace>
  void trace_image(const accel::PrimaryRays& image, const accel::QueryContext& context,
                   const Trace& trace) const {
    const std::size_t row =
        static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.samples());
    const int rows_at_once = tracer_->takes_whole_queries()
                                 ? image.height()
                                 : static_cast<int>(1 + (kImageBatch - 1) / row);
    accel::for_rows(context, image.height(), [&](int begin, int end, auto&) {
      std::vector<Ray> made(row * static_cast<std::size_t>(std::min(rows_at_once, end - begin)));
      for (int y = begin; y < end; y += rows_at_once) {
        const int next = std::min(y + rows_at_once, end);
        const std::size_t first = row * static_cast<std::size_t>(y);
        image.for_each(y, next,
                       [&](std::size_t index, const Ray& ray) { made[index - first] = ray; });
        trace(first,
              batch_of(std::span(made).first(row * static_cast<std::size_t>(next - y)), row));
      }
    });
  }

  std::unique_ptr<BatchTracer> tracer_;
};

}  // namespace

std::unique_ptr<accel::Accelerator> structure_of(std::unique_ptr<BatchTracer> tracer) {
  return std::make_unique<BatchStructure>(std::move(tracer));
}

}  // namespace beambench::plugin
