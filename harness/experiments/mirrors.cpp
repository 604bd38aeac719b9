#include "harness/experiments/mirrors.hpp"

#include <algorithm>

#include "accel/beam/mirror_beams.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/bench/record/robust_statistics.hpp"
#include "harness/rays/trace_input.hpp"

namespace beambench::experiments {
namespace {

template <class Work>
double median_ms(int repetitions, Work work) {
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    const base::Stopwatch stopwatch;
    work();
    times.push_back(stopwatch.milliseconds());
  }
  return bench::median(times);
}

/// The samples of an image that see a mirror.
std::vector<rays::PixelSample> seeing(const scenes::PlanarMirror& mirror,
                                      const accel::HitBuffer& hits) {
  std::vector<rays::PixelSample> samples;
  for (int y = 0; y < hits.height(); ++y) {
    for (int x = 0; x < hits.width(); ++x) {
      for (int sample = 0; sample < hits.samples(); ++sample) {
        const scenes::PrimitiveId id = hits.primitive()[hits.index(x, y, sample)];
        if (std::binary_search(mirror.polygons.begin(), mirror.polygons.end(), id)) {
          samples.push_back({x, y, sample});
        }
      }
    }
  }
  return samples;
}

/// By single rays through the same octree, made as they are needed.
void trace_singly(const accel::beam::BeamTracer& tracer, const accel::beam::MirrorView& view,
                  const std::vector<rays::PixelSample>& samples, accel::HitBuffer& found) {
  for (const rays::PixelSample& at : samples) {
    found.set(found.index(at.x, at.y, at.sample),
              tracer.closest_hit(accel::beam::ray_behind(view, at.x, at.y, at.sample), nullptr));
  }
}

MirrorResult compare(const accel::beam::BeamTracer& tracer, const accel::beam::MirrorView& view,
                     const accel::HitBuffer& hits, const scenes::PlanarMirror& mirror,
                     int repetitions) {
  accel::HitBuffer by_rays(hits.width(), hits.height(), hits.samples());
  accel::HitBuffer by_beams = by_rays;
  MirrorResult result{mirror.polygons.size(), view.samples};
  const std::vector<rays::PixelSample> samples = seeing(mirror, hits);
  result.rays_ms = median_ms(repetitions, [&] { trace_singly(tracer, view, samples, by_rays); });
  result.beams_ms =
      median_ms(repetitions, [&] { tracer.trace_behind(view.sight, view.rays, by_beams); });
  for (std::size_t i = 0; i < hits.size(); ++i) {
    result.hits += by_rays.get(i).has_value() ? 1 : 0;
    result.different += by_rays.get(i) == by_beams.get(i) ? 0 : 1;
  }
  return result;
}

}  // namespace

MirrorResult& MirrorResult::operator+=(const MirrorResult& other) {
  polygons += other.polygons;
  samples += other.samples;
  hits += other.hits;
  different += other.different;
  rays_ms += other.rays_ms;
  beams_ms += other.beams_ms;
  return *this;
}

MirrorComparison compare_mirrors(const accel::beam::BeamTracer& tracer, const scenes::Scene& scene,
                                 const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                                 int repetitions) {
  const std::vector<scenes::PlanarMirror> mirrors = scenes::planar_mirrors(scene);
  MirrorComparison comparison{mirrors.size(), {}};
  for (const scenes::PlanarMirror& mirror : mirrors) {
    const auto view = accel::beam::view_in(mirror, scene, rays, hits);
    if (view) comparison.seen.push_back(compare(tracer, *view, hits, mirror, repetitions));
  }
  return comparison;
}

}  // namespace beambench::experiments
