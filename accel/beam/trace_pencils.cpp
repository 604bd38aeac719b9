// Traces lists of rays: rays that planes reflect or refract in beams, all other rays one by one.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "accel/beam/beam_tracer.hpp"
#include "accel/beam/drifting_view.hpp"
#include "accel/core/cell_ray.hpp"

namespace beambench::accel::beam {
namespace {

/// The maximum deviation, in pixels, of a reflected ray from the virtual eye's ray; it is caused
/// only by rounding.
constexpr double kMostOfMirrors = 0.25;
/// Refracted rays are divided into parts of the image until they deviate from a view of their part
/// by less than this angle (half a pixel) or too few rays remain. On aquarium and prism, values
/// from 0.25 to 1 take equally long.
constexpr double kDivided = 0.5;
/// Refracted rays that deviate from the view of their part by more than this many pixels are left
/// out.
constexpr double kMostOfGlass = 2.0;
/// The maximum number of rays to which a view is fitted.
constexpr std::size_t kFitted = 128;

using Indices = std::span<std::uint32_t>;  // of rays in a batch

/// Traces the rays of a batch.
template <class Counting>
class BatchRun {
 public:
  BatchRun(const BeamTracer& tracer, const RayBatch& batch, const HitSpan& hits, Counting& counting,
           std::span<std::uint8_t> alone)
      : tracer_(&tracer), batch_(&batch), hits_(hits), counting_(&counting), alone_(alone) {}

  void operator()() {
    std::size_t next = 0;
    const auto until = [&](std::size_t end) {
      for (; next < end; ++next) trace_alone(next);
    };
    const auto refracted = batch_->marks != nullptr && batch_->image != nullptr
                               ? std::span(batch_->marks->refracted)
                               : std::span<const RefractedRays>();
    auto glass = refracted.begin();
    const auto trace_glass = [&](std::size_t end) {
      for (; glass != refracted.end() && glass->first < end; ++glass) {
        until(glass->first);
        next = glass->first + glass->count;
        trace_refracted(*glass);
      }
    };
    for (const Pencil& pencil : batch_->pencils) {
      trace_glass(pencil.first);
      if (pencil.toward || pencil.view == nullptr || !suits(pencil.count)) continue;
      until(pencil.first);
      next = pencil.first + pencil.count;
      trace_reflected(pencil);
    }
    trace_glass(batch_->rays.size());
    until(batch_->rays.size());
  }

 private:
  bool suits(std::size_t rays) const {
    return rays >= BehindPlane::kFewest && !batch_->samples.empty();
  }

  void trace_alone(std::size_t index) {
    hits_.set(index, tracer_->find_closest(batch_->rays[index], *counting_));
    if (!alone_.empty()) alone_[index] = 1;
  }

  void trace_reflected(const Pencil& pencil) {
    const DriftingView view{*pencil.view, pencil.apex};
    trace_behind({batch_->rays.subspan(pencil.first, pencil.count),
                  batch_->samples.subspan(pencil.first, pencil.count), view, kMostOfMirrors,
                  tracer_->scene(), tracer_->octree()},
                 [&](std::size_t i) { return pencil.first + i; });
  }

  void trace_refracted(const RefractedRays& marked) {
    std::vector<std::uint32_t> indices(marked.count);
    std::iota(indices.begin(), indices.end(), static_cast<std::uint32_t>(marked.first));
    trace_part(indices);
  }

  /// Traces a part of the image, or divides it if one view does not fit all of its rays.
  void trace_part(Indices part) {
    if (!suits(part.size())) return trace_each(part);
    const std::optional<DriftingView> view = view_of(part);
    if (part.size() >= 2 * BehindPlane::kFewest && !(view && fits(*view, part))) {
      const std::size_t half = divide(part);
      if (half == 0) return trace_each(part);
      trace_part(part.first(half));
      return trace_part(part.subspan(half));
    }
    if (!view) return trace_each(part);
    std::vector<Ray> rays;
    std::vector<std::uint32_t> samples;
    gather(part, 1, rays, samples);
    trace_behind({rays, samples, *view, kMostOfGlass, tracer_->scene(), tracer_->octree()},
                 [&](std::size_t i) { return part[i]; });
  }

  void trace_each(Indices part) {
    for (const std::uint32_t index : part) trace_beside(index);
  }

  /// Traces a marked ray that is in no beam; one that misses the octree needs no tracing.
  void trace_beside(std::size_t index) {
    const Ray& ray = batch_->rays[index];
    if (std::isinf(CellRay(tracer_->octree().grid(), ray).enter(ray.t_min))) {
      return hits_.set(index, std::nullopt);
    }
    trace_alone(index);
    counting_->add("rays_beside_beams");
  }

  void gather(Indices part, std::size_t step, std::vector<Ray>& rays,
              std::vector<std::uint32_t>& samples) const {
    for (std::size_t i = 0; i < part.size(); i += step) {
      rays.push_back(batch_->rays[part[i]]);
      samples.push_back(batch_->samples[part[i]]);
    }
  }

  std::optional<DriftingView> view_of(Indices part) const {
    std::vector<Ray> rays;
    std::vector<std::uint32_t> samples;
    gather(part, step_of(part), rays, samples);
    return fitted_view(rays, samples, *batch_->image);
  }

  /// Returns an odd step through a part, so that steps do not stay in one column of the image.
  static std::size_t step_of(Indices part) { return (part.size() / kFitted) | 1U; }

  /// Returns whether the rays of the part deviate little from the view, judging by some of them.
  bool fits(const DriftingView& view, Indices part) const {
    const double most = kDivided * view.pixel();
    const std::size_t step = step_of(part);
    for (std::size_t i = step / 2; i < part.size(); i += step) {
      const Course course =
          view.course_of(batch_->rays[part[i]], place_in(view.image, batch_->samples[part[i]]));
      // The second term is the part of the conic that its tangent omits.
      const double deviation =
          course.deviation + course.drifted * course.from_center / course.start;
      if (!(deviation < most)) return false;
    }
    return true;
  }

  /// Divides a part at the middle of its longer side; returns how many rays are in the first half.
  std::size_t divide(Indices part) const {
    const auto pixel_of = [&](std::uint32_t index) {
      return place_in(*batch_->image, batch_->samples[index]).pixel;
    };
    glm::ivec2 first = pixel_of(part.front());
    glm::ivec2 last = first;
    for (const std::uint32_t index : part) {
      first = glm::min(first, pixel_of(index));
      last = glm::max(last, pixel_of(index));
    }
    const int axis = last.y - first.y > last.x - first.x ? 1 : 0;
    const int middle = (first[axis] + last[axis]) / 2;
    const auto half = std::stable_partition(part.begin(), part.end(), [&](std::uint32_t index) {
      return pixel_of(index)[axis] <= middle;
    });
    return first[axis] == last[axis] ? 0 : static_cast<std::size_t>(half - part.begin());
  }

  /// Traces the rays behind a plane in beams, and rays that are in no beam singly. `index_of(i)` is
  /// the index in the batch of the i-th ray.
  template <class IndexOf>
  void trace_behind(const BehindPlane& plane, IndexOf index_of) {
    HitBuffer seen = plane.buffer();
    std::vector<std::uint8_t> finished = plane.finished();
    const auto trace = [&](auto watch) {
      BeamRun<decltype(watch), BehindPlane>(tracer_->scene(), *tracer_, tracer_->options(),
                                            plane.image(), plane, seen, finished, watch)();
    };
    if constexpr (std::is_same_v<Counting, WorkCounters>) {
      trace(CountingBeamWatch(*counting_));
    } else {
      trace(NoBeamWatch());
    }
    std::size_t i = 0;
    for (const std::uint32_t place : plane.places()) {
      const std::size_t index = index_of(i++);
      if (place != BehindPlane::kNone && finished[place] != 0) {
        hits_.set(index, seen.get(place));
      } else {
        trace_beside(index);
      }
    }
  }

  const BeamTracer* tracer_;
  const RayBatch* batch_;
  HitSpan hits_;
  Counting* counting_;
  std::span<std::uint8_t> alone_;
};

}  // namespace

void BeamTracer::trace_batch(const RayBatch& batch, const HitSpan& hits,
                             WorkCounters* counters) const {
  with_counting(counters, [&](auto& counting) { BatchRun(*this, batch, hits, counting, {})(); });
}

std::vector<std::uint8_t> BeamTracer::traced_alone(const RayBatch& batch) const {
  std::vector<std::uint8_t> alone(batch.rays.size());
  HitBuffer hits(static_cast<int>(batch.rays.size()), 1, 1);
  NoCounting none;
  BatchRun(*this, batch, HitSpan(hits), none, alone)();
  return alone;
}

}  // namespace beambench::accel::beam
